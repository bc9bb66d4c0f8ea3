// SPDX-License-Identifier: BSD-3-Clause
#include "ground/ground_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <optional>

namespace soslam {
namespace {

constexpr double kLeastErrorPx = 0.5;
// Error of a point's depth that all its views share, as a fraction.
constexpr double kDepthError = 1e-3;

std::optional<GroundPoint> GroundPointOf(const Sequence& sequence,
                                         const std::map<int, int>& frame_index_of,
                                         const MapPoint& point) {
  GroundPoint result{point.position_in_world, Eigen::Matrix3d::Zero(), {}};
  const double sigma_px = std::max(kLeastErrorPx, point.reprojection_error_px);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double nearest = 0.0;
  for (const PointObservation& observation : point.observations) {
    const auto index = frame_index_of.find(observation.frame_id);
    if (index == frame_index_of.end()) continue;
    const Frame& frame = sequence.frames[static_cast<size_t>(index->second)];
    const Eigen::Vector3d in_camera = frame.world_from_camera.Inverse() * point.position_in_world;
    if (!(in_camera.z() > 0.0)) return std::nullopt;
    const Eigen::Matrix<double, 2, 3> d_world =
        sequence.CameraOf(frame).ProjectionJacobian(in_camera) *
        frame.world_from_camera.rotation.toRotationMatrix().transpose();
    information += d_world.transpose() * d_world / (sigma_px * sigma_px);
    nearest = result.frame_indices.empty() ? in_camera.z() : std::min(nearest, in_camera.z());
    result.frame_indices.push_back(index->second);
  }
  if (result.frame_indices.size() < 2) return std::nullopt;
  result.covariance = information.inverse();
  result.covariance.diagonal().array() += kDepthError * kDepthError * nearest * nearest;
  return result.covariance.allFinite() ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace

std::vector<GroundPoint> GroundPoints(const Sequence& sequence,
                                      const std::vector<MapPoint>& points) {
  std::map<int, int> frame_index_of;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    frame_index_of[sequence.frames[i].id] = static_cast<int>(i);
  }
  std::vector<GroundPoint> result;
  for (const MapPoint& point : points) {
    if (auto one = GroundPointOf(sequence, frame_index_of, point)) {
      result.push_back(std::move(*one));
    }
  }
  return result;
}

}  // namespace soslam
