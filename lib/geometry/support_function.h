// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/superquadric_norm.h"

namespace soslam {

// The support function at a direction, and its derivatives.
struct SupportValue {
  double extent;                    // h, in metres where |m| = 1
  Eigen::Vector3d point;            // dh / dm: the support point
  Eigen::Vector3d d_log_half_axes;  // dh / d log (a, b, c)
};
inline constexpr double kEdgeRounding = 1e-3;

// Support function of a superquadric with half axes (a, b, c) in a direction m of the object frame,
// of any length: the maximum of m . x over the body, which is the SuperquadricNorm of (a m_1,
// b m_2, c m_3). The body itself is F(x) = || (x / a, y / b, z / c) || <= 1 by the norm with the
// DualExponents.
//
// For exponents below 2 the norm has kinks where a component of m vanishes. |m_i| is therefore
// replaced by sqrt(m_i^2 + e^2 |m|^2) with e = kEdgeRounding (2 - p), p the smaller exponent: the
// exact norm at p = 2, otherwise still convex and homogeneous, hence the support function of a body
// whose edges are rounded by a thousandth of its size.
//
// Requires 1 <= exponents <= 2, half_axes >= 0, and a direction that is not zero.
SupportValue SupportFunction(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                             const Eigen::Vector3d& direction_in_object);

// The Hessian d^2 h / dm^2: positive semidefinite, as a support function is convex, with m in its
// null space, as it is homogeneous. Zero where SupportFunction has no extent.
Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                               const Eigen::Vector3d& direction_in_object);

}  // namespace soslam
