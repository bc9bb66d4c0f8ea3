// SPDX-License-Identifier: BSD-3-Clause
#include "ground/ground_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>

namespace soslam {
namespace {

constexpr double kLeastErrorPx = 0.5;
// Error of a point's depth that all its views share, as a fraction.
constexpr double kDepthError = 1e-3;

std::optional<GroundPoint> GroundPointOf(const Sequence& sequence, const MapPoint& point) {
  GroundPoint result{point.position_in_world, Eigen::Matrix3d::Zero(), {}};
  const double sigma_px = std::max(kLeastErrorPx, point.reprojection_error_px);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double nearest = 0.0;
  for (const PointObservation& observation : point.observations) {
    const auto index = FrameIndexOf(sequence, observation);
    if (!index) continue;
    const Frame& frame = sequence.frames[*index];
    const Eigen::Vector3d in_camera = frame.world_from_camera.Inverse() * point.position_in_world;
    if (!(in_camera.z() > 0.0)) return std::nullopt;
    const Eigen::Matrix<double, 2, 3> d_world =
        sequence.CameraOf(frame).ProjectionJacobian(in_camera) *
        frame.world_from_camera.rotation.toRotationMatrix().transpose();
    information += d_world.transpose() * d_world / (sigma_px * sigma_px);
    nearest = result.frame_indices.empty() ? in_camera.z() : std::min(nearest, in_camera.z());
    result.frame_indices.push_back(static_cast<int>(*index));
  }
  if (result.frame_indices.size() < 2) return std::nullopt;
  result.covariance = information.inverse();
  result.covariance.diagonal().array() += kDepthError * kDepthError * nearest * nearest;
  return result.covariance.allFinite() ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace

std::vector<GroundPoint> GroundPoints(const Sequence& sequence,
                                      const std::vector<MapPoint>& points) {
  std::vector<GroundPoint> result;
  for (const MapPoint& point : points) {
    if (auto one = GroundPointOf(sequence, point)) result.push_back(std::move(*one));
  }
  return result;
}

}  // namespace soslam
