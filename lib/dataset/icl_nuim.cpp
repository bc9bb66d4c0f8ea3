// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/icl_nuim.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {

Camera WithYDown(const Camera& camera_with_y_up) {
  if (!(camera_with_y_up.fy < 0.0)) {
    throw InputError(
        fmt::format("fy is {}; expected ICL-NUIM's, which is negative", camera_with_y_up.fy));
  }
  Camera camera = camera_with_y_up;
  camera.fy = -camera.fy;
  return camera;
}

Rigid3d MirroredInY(const Rigid3d& world_from_camera) {
  // With S = diag(1, -1, 1), S R S rotates about the mirrored axis by the opposite angle.
  const Eigen::Quaterniond& q = world_from_camera.rotation;
  const Eigen::Vector3d& t = world_from_camera.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

std::vector<TimedPose> FromIclNuim(const std::vector<TimedPose>& published) {
  std::vector<TimedPose> trajectory;
  for (const TimedPose& pose : published) {
    trajectory.push_back(
        {pose.timestamp / kIclNuimFramesPerSecond, MirroredInY(pose.world_from_camera)});
  }
  return trajectory;
}

}  // namespace soslam
