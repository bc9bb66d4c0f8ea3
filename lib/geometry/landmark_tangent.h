// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/landmark.h"

namespace soslam {

// The nine degrees of freedom of a landmark in tangent space: rotation vector (in the frame that
// the landmark is given in, applied from the left, rad), centre (m), log half axes. Derivatives by
// a landmark are with respect to these, in this order; residuals mostly have the landmark in the
// camera frame.
inline constexpr int kLandmarkDof = 9;
using LandmarkStep = Eigen::Matrix<double, kLandmarkDof, 1>;
using LandmarkJacobian3 = Eigen::Matrix<double, 3, kLandmarkDof>;
using LandmarkJacobian2 = Eigen::Matrix<double, 2, kLandmarkDof>;
using LandmarkJacobian1 = Eigen::Matrix<double, 1, kLandmarkDof>;

// The landmark to which a step leads.
Landmark Moved(const Landmark& landmark, const LandmarkStep& step);

}  // namespace soslam
