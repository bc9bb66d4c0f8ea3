// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/support_function.h"

namespace soslam {

// The second derivatives of SupportFunction by direction m and log half axes s. By m they are
// positive semidefinite, and large where an edge or a face of a body with p < 2 turns past the
// direction: a thousand times the body's size for a cuboid.
struct SupportCurvature {
  Eigen::Matrix3d by_direction;      // d^2 h / dm dm
  Eigen::Matrix3d mixed;             // d^2 h / ds dm: a row for each half axis
  Eigen::Matrix3d by_log_half_axes;  // d^2 h / ds ds
};

// At the direction whose value is given.
SupportCurvature CurvatureOfSupport(const Eigen::Vector3d& half_axes, double shape_exponent,
                                    const Eigen::Vector3d& direction_in_object,
                                    const SupportValue& value);

}  // namespace soslam
