// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "geometry/rigid3.h"

namespace soslam {

// The rotation nearest to a matrix that was rounded in a file. Throws InputError, naming `place`,
// when it is no rotation within rounding.
Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place);

// The rigid motion of a 4 x 4 matrix, with an exact rotation. Throws InputError also when its last
// row is not 0 0 0 1, as in a matrix written by columns.
Rigid3d RigidMotion(const Eigen::Matrix4d& matrix, const std::string& place);

}  // namespace soslam
