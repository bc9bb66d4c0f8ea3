// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_function.h"

#include <algorithm>

namespace soslam {
namespace {

// e^2 of the rounding.
double SquaredRounding(const ShapeExponents& exponents) {
  const double rounding =
      kEdgeRounding * (kEllipsoidExponent - std::min(exponents.horizontal, exponents.vertical));
  return rounding * rounding;
}

// The rounded |m_i|; nowhere zero but for the ellipsoid, which has no kinks.
Eigen::Array3d RoundedDirection(const Eigen::Vector3d& direction, double squared_rounding) {
  return (direction.array().square() + squared_rounding * direction.squaredNorm()).sqrt();
}

}  // namespace

SupportValue SupportFunction(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                             const Eigen::Vector3d& direction_in_object) {
  const double squared_rounding = SquaredRounding(exponents);
  const Eigen::Array3d rounded = RoundedDirection(direction_in_object, squared_rounding);
  const Eigen::Array3d u = half_axes.array() * rounded;
  const auto [extent, slopes] = SuperquadricNorm(u, exponents);
  // d u_i / d m_j = s_i (m_i [i = j] + e^2 m_j) / rounded_i
  const Eigen::Array3d d_squares =
      (rounded > 0.0).select(slopes * half_axes.array() / rounded, 0.0);
  return {extent, (d_squares + d_squares.sum() * squared_rounding) * direction_in_object.array(),
          slopes * u};
}

Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                               const Eigen::Vector3d& direction_in_object) {
  const Eigen::Vector3d& m = direction_in_object;
  const double squared_rounding = SquaredRounding(exponents);
  const Eigen::Array3d rounded = RoundedDirection(m, squared_rounding);
  Eigen::Matrix3d by_u;
  const auto [extent, slopes] = SuperquadricNorm(half_axes.array() * rounded, exponents, &by_u);
  if (!(extent > 0.0)) return Eigen::Matrix3d::Zero();
  // With r_i the rounded |m_i|: dr_i / dm = (m_i e_i + e^2 m) / r_i, and
  // d^2 r_i / dm^2 = (e_i e_i^T + e^2 I - (dr_i / dm) (dr_i / dm)^T) / r_i.
  Eigen::Matrix3d d_rounded;  // row i: dr_i / dm
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    if (!(rounded[i] > 0.0)) {  // the ellipsoid, where |m_i| has the slope of m_i
      d_rounded.row(i) = unit.transpose();
      continue;
    }
    const Eigen::Vector3d slope = (m[i] * unit + squared_rounding * m) / rounded[i];
    d_rounded.row(i) = slope.transpose();
    hessian += slopes[i] * half_axes[i] / rounded[i] *
               (unit * unit.transpose() + squared_rounding * Eigen::Matrix3d::Identity() -
                slope * slope.transpose());
  }
  const Eigen::Matrix3d d_u = half_axes.asDiagonal() * d_rounded;
  return hessian + d_u.transpose() * by_u * d_u;
}

}  // namespace soslam
