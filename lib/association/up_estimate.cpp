// SPDX-License-Identifier: BSD-3-Clause
#include "association/up_estimate.h"

#include <Eigen/Dense>
#include <numbers>
#include <vector>

#include "geometry/rigid3.h"
#include "planes/camera_attitude.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

UpEstimate UpOf(const std::vector<Rigid3d>& world_from_camera, const AssociateOptions& options) {
  const CameraAttitude attitude = AttitudeOf(
      world_from_camera, options.camera_roll_sigma_deg * kRadians,
      options.camera_pitch_sigma_deg * kRadians, options.view_correlation_deg * kRadians);
  const Eigen::Vector3d& up = attitude.up_in_world;
  // Turns about these two move up by their cross products with it.
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = up.unitOrthogonal();
  axes.col(1) = up.cross(axes.col(0));
  const Eigen::Matrix<double, 3, 2> by_turns = -Skew(up) * axes;
  const Eigen::Matrix2d information = by_turns.transpose() * attitude.information * by_turns;
  return {up, axes * information.inverse() * axes.transpose()};
}

}  // namespace

std::map<int, UpEstimate> UpOfSegments(const Sequence& sequence, const AssociateOptions& options) {
  std::map<int, std::vector<Rigid3d>> poses;
  for (const Frame& frame : sequence.frames) {
    poses[frame.segment].push_back(frame.world_from_camera);
  }
  std::map<int, UpEstimate> up;
  for (const auto& [segment, world_from_camera] : poses) {
    up[segment] = UpOf(world_from_camera, options);
  }
  return up;
}

}  // namespace soslam
