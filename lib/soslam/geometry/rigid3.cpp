// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/rigid3.h"

#include <cmath>

namespace soslam {

Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& rotation_vector) {
  const double half_angle = 0.5 * rotation_vector.norm();
  // sin(x) / x, by its series where the quotient loses digits.
  const double sinc =
      half_angle > 1e-4 ? std::sin(half_angle) / half_angle : 1.0 - half_angle * half_angle / 6.0;
  Eigen::Quaterniond rotation;
  rotation.vec() = 0.5 * sinc * rotation_vector;
  rotation.w() = std::cos(half_angle);
  return rotation.normalized();
}

Eigen::Vector3d LogRotation(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double sine = rotation.vec().norm();
  const double half_angle = std::atan2(sine, sign * rotation.w());
  const double scale = sine > 1e-9 ? 2.0 * half_angle / sine : 2.0;
  return sign * scale * rotation.vec();
}

Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace soslam
