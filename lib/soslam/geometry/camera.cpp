// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/camera.h"

#include <fmt/format.h>

namespace soslam {

Eigen::Matrix3d Camera::Intrinsics() const {
  Eigen::Matrix3d intrinsics;
  intrinsics << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return intrinsics;
}

Eigen::Matrix<double, 2, 3> Camera::ProjectionJacobian(
    const Eigen::Vector3d& point_in_camera) const {
  const double inverse_depth = 1.0 / point_in_camera.z();
  Eigen::Matrix<double, 2, 3> jacobian;
  jacobian << fx, 0.0, -fx * point_in_camera.x() * inverse_depth,  //
      0.0, fy, -fy * point_in_camera.y() * inverse_depth;
  return inverse_depth * jacobian;
}

Plane Camera::BackProject(const Eigen::Vector3d& line) const {
  const Eigen::Vector3d normal = Intrinsics().transpose() * line;
  return {normal.normalized(), 0.0};
}

std::string TooLargeImage(const Camera& camera) {
  if (IsImageSize(camera.width, camera.height)) return "";
  return fmt::format("is of {} x {} pixels; expected at most {} in all", camera.width,
                     camera.height, kMaxPixels);
}

}  // namespace soslam
