// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace soslam {

// Shape exponents p: 1 is the cuboid, 2 the ellipsoid, superquadrics in between.
inline constexpr double kCuboidExponent = 1.0;
inline constexpr double kEllipsoidExponent = 2.0;

// Support function of a superquadric with half axes (a, b, c) in a direction m of the object frame,
// of any length: h_p(m) = || (a m_1, b m_2, c m_3) ||_p, the maximum of m . x over the body. The
// body itself is || (x / a, y / b, z / c) ||_q <= 1 with 1 / p + 1 / q = 1.
//
// For p -> 1 the norm has kinks where a component of m vanishes. |m_i| is therefore replaced by
// sqrt(m_i^2 + e^2 |m|^2) with e = kEdgeRounding (2 - p): the exact norm at p = 2, otherwise still
// convex and homogeneous, hence the support function of a body whose edges are rounded by a
// thousandth of its size.
struct SupportValue {
  double extent;                    // h, in metres where |m| = 1
  Eigen::Vector3d contact;          // dh / dm: the support point
  Eigen::Vector3d d_log_half_axes;  // dh / d log (a, b, c)
};
inline constexpr double kEdgeRounding = 1e-3;
constexpr double SquaredRounding(double shape_exponent) {  // e^2
  const double rounding = kEdgeRounding * (kEllipsoidExponent - shape_exponent);
  return rounding * rounding;
}

// Requires 1 <= shape_exponent <= 2, half_axes >= 0, and a direction that is not zero.
SupportValue SupportFunction(const Eigen::Vector3d& half_axes, double shape_exponent,
                             const Eigen::Vector3d& direction_in_object);

// The Hessian d^2 h / dm^2: positive semidefinite, as a support function is convex, with m in its
// null space, as it is homogeneous. Zero where SupportFunction has no extent.
Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, double shape_exponent,
                               const Eigen::Vector3d& direction_in_object);

// The derivatives d h / d u_i = (u_i / h)^(p - 1) of the norm h = || u ||_p; u >= 0, not zero.
Eigen::Array3d NormDerivatives(const Eigen::Array3d& u, double p, double* norm);

}  // namespace soslam
