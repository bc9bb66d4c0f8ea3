// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "soslam/geometry/rigid3.h"

namespace soslam {

// The pose of a level camera at `position` that looks at `target`, in a world whose z is up.
inline Rigid3d LookingAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - position).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return {Eigen::Quaterniond(axes), position};
}

}  // namespace soslam
