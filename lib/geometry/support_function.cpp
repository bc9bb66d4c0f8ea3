// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_function.h"

#include <cmath>

namespace soslam {
namespace {

// Support of a flat body across its plane.
SupportValue NoExtent() { return {0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

// Support function of an ellipsoid, h = || (a m_1, b m_2, c m_3) ||.
SupportValue OfEllipsoid(const Eigen::Vector3d& half_axes, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d scaled = half_axes.cwiseProduct(direction);
  const double extent = scaled.norm();
  if (!(extent > 0.0)) return NoExtent();
  const double inverse = 1.0 / extent;
  return {extent, inverse * half_axes.cwiseProduct(scaled), inverse * scaled.cwiseAbs2()};
}

// The rounded |m_i|.
Eigen::Array3d RoundedDirection(const Eigen::Vector3d& direction, double shape_exponent) {
  return (direction.array().square() + SquaredRounding(shape_exponent) * direction.squaredNorm())
      .sqrt();
}

}  // namespace

Eigen::Array3d NormDerivatives(const Eigen::Array3d& u, double p, double* norm) {
  if (p == kCuboidExponent) {
    *norm = u.sum();
    return Eigen::Array3d::Ones();
  }
  const double largest = u.maxCoeff();
  const Eigen::Array3d ratio = u / largest;
  // r^p = r r^(p - 1): one power serves both, and no base exceeds 1.
  const Eigen::Array3d power(std::pow(ratio.x(), p - 1.0), std::pow(ratio.y(), p - 1.0),
                             std::pow(ratio.z(), p - 1.0));
  const double sum = (ratio * power).sum();
  const double root = std::pow(sum, 1.0 / p);
  *norm = largest * root;
  return power * (root / sum);
}

SupportValue SupportFunction(const Eigen::Vector3d& half_axes, double shape_exponent,
                             const Eigen::Vector3d& direction_in_object) {
  const double p = shape_exponent;
  if (p == kEllipsoidExponent) return OfEllipsoid(half_axes, direction_in_object);
  const Eigen::Array3d rounded = RoundedDirection(direction_in_object, p);
  const Eigen::Array3d u = half_axes.array() * rounded;
  if (!(u.maxCoeff() > 0.0)) return NoExtent();

  SupportValue value;
  const Eigen::Array3d d_u = NormDerivatives(u, p, &value.extent);
  value.d_log_half_axes = d_u * u;
  // d u_i / d m_j = s_i (m_i [i = j] + e^2 m_j) / rounded_i; rounded is nowhere zero for p < 2
  const Eigen::Array3d d_squares = d_u * half_axes.array() / rounded;
  value.contact = (d_squares + d_squares.sum() * SquaredRounding(p)) * direction_in_object.array();
  return value;
}

// With r_i the rounded |m_i| and l_i = dh / d log s_i:
//   sum_i l_i / r_i^2 (e_i e_i^T + e^2 I - (2 - p) g_i g_i^T) - (p - 1) / h c c^T,
// where g_i = (m_i e_i + e^2 m) / r_i and c = dh / dm.
Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, double shape_exponent,
                               const Eigen::Vector3d& direction_in_object) {
  const double p = shape_exponent;
  const double rounding = SquaredRounding(p);
  const Eigen::Vector3d& m = direction_in_object;
  const SupportValue value = SupportFunction(half_axes, p, m);
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  if (!(value.extent > 0.0)) return hessian;
  for (int i = 0; i < 3; ++i) {
    const double squared = m[i] * m[i] + rounding * m.squaredNorm();
    if (!(squared > 0.0)) {  // only at p = 2, where l_i / r_i^2 is s_i^2 / h
      hessian(i, i) += half_axes[i] * half_axes[i] / value.extent;
      continue;
    }
    const double share = value.d_log_half_axes[i] / squared;
    const Eigen::Vector3d g = m[i] * Eigen::Vector3d::Unit(i) + rounding * m;
    hessian.diagonal().array() += share * rounding;
    hessian(i, i) += share;
    hessian -= (2.0 - p) * share / squared * g * g.transpose();
  }
  return hessian - (p - 1.0) / value.extent * value.contact * value.contact.transpose();
}

}  // namespace soslam
