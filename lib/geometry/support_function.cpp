// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_function.h"

#include <cmath>
#include <limits>

namespace soslam {
namespace {

// A flat body, from its side.
SupportValue NoExtent() { return {0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

// h = || (a m_1, b m_2, c m_3) ||.
SupportValue OfEllipsoid(const Eigen::Vector3d& half_axes, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d scaled = half_axes.cwiseProduct(direction);
  const double extent = scaled.norm();
  if (!(extent > 0.0)) return NoExtent();
  const double inverse = 1.0 / extent;
  return {extent, inverse * half_axes.cwiseProduct(scaled), inverse * scaled.cwiseAbs2()};
}

double RoundingOf(double shape_exponent) {
  return kEdgeRounding * (kEllipsoidExponent - shape_exponent);
}

// d h / d u_i of h = || u ||_p, u >= 0: (u_i / h)^(p - 1).
Eigen::Array3d NormByComponents(const Eigen::Array3d& u, double p, double* norm) {
  if (p == kCuboidExponent) {
    *norm = u.sum();
    return Eigen::Array3d::Ones();
  }
  const double largest = u.maxCoeff();
  const Eigen::Array3d ratio = u / largest;
  // r^p = r r^(p - 1): one power serves both, and none is of a number above 1.
  const Eigen::Array3d power(std::pow(ratio.x(), p - 1.0), std::pow(ratio.y(), p - 1.0),
                             std::pow(ratio.z(), p - 1.0));
  const double sum = (ratio * power).sum();
  const double root = std::pow(sum, 1.0 / p);
  *norm = largest * root;
  return power * (root / sum);
}

}  // namespace

SupportValue SupportFunction(const Eigen::Vector3d& half_axes, double shape_exponent,
                             const Eigen::Vector3d& direction_in_object) {
  const double p = shape_exponent;
  if (p == kEllipsoidExponent) return OfEllipsoid(half_axes, direction_in_object);
  const double squared_rounding = RoundingOf(p) * RoundingOf(p);
  // u_i = s_i sqrt(m_i^2 + e^2 |m|^2)
  const Eigen::Array3d rounded =
      (direction_in_object.array().square() + squared_rounding * direction_in_object.squaredNorm())
          .sqrt();
  const Eigen::Array3d u = half_axes.array() * rounded;
  if (!(u.maxCoeff() > 0.0)) return NoExtent();

  SupportValue value;
  const Eigen::Array3d by_u = NormByComponents(u, p, &value.extent);
  value.by_log_half_axes = by_u * u;
  // d u_i / d m_j = s_i (m_i [i = j] + e^2 m_j) / rounded_i; rounded is nowhere zero for p < 2
  const Eigen::Array3d by_squares = by_u * half_axes.array() / rounded;
  value.contact = (by_squares + by_squares.sum() * squared_rounding) * direction_in_object.array();
  return value;
}

SupportInDirections::SupportInDirections(double shape_exponent, const Rows& directions_in_object)
    : shape_exponent_(shape_exponent) {
  const Eigen::Array4d least_squares = RoundingOf(shape_exponent) * RoundingOf(shape_exponent) *
                                       directions_in_object.square().rowwise().sum();
  rounded_ = (directions_in_object.square().colwise() + least_squares).sqrt();
}

SupportInDirections::Values SupportInDirections::Of(const Eigen::Vector3d& half_axes) const {
  const Rows u = rounded_.rowwise() * half_axes.transpose().array();
  if (shape_exponent_ == kCuboidExponent) return {u.rowwise().sum(), u};
  Values values;
  if (shape_exponent_ == kEllipsoidExponent) {
    const Rows squares = u.square();
    values.extents = squares.rowwise().sum().sqrt();
    values.by_log_half_axes =
        squares.colwise() / values.extents.max(std::numeric_limits<double>::min());
    return values;
  }
  for (int i = 0; i < u.rows(); ++i) {
    const Eigen::Array3d of_row = u.row(i);
    values.extents[i] = 0.0;
    values.by_log_half_axes.row(i).setZero();
    if (!(of_row.maxCoeff() > 0.0)) continue;
    values.by_log_half_axes.row(i) =
        of_row * NormByComponents(of_row, shape_exponent_, &values.extents[i]);
  }
  return values;
}

}  // namespace soslam
