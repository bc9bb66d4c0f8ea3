// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace soslam {

// The rotation nearest to a matrix that a file rounded. Throws InputError, naming `place`, when it
// is no rotation within what rounding explains.
Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place);

}  // namespace soslam
