// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_function.h"

#include <cmath>

namespace soslam {

SupportValue SupportFunction(const Eigen::Vector3d& half_axes, double shape_exponent,
                             const Eigen::Vector3d& direction_in_object) {
  const double p = shape_exponent;
  const double rounding = kEdgeRounding * (kEllipsoidExponent - p);
  const double squared_length = direction_in_object.squaredNorm();
  // u_i = s_i sqrt(m_i^2 + e^2 |m|^2); h = (sum u_i^p)^(1/p), scaled by the largest u_i.
  const Eigen::Array3d rounded =
      (direction_in_object.array().square() + rounding * rounding * squared_length).sqrt();
  const Eigen::Array3d u = half_axes.array() * rounded;
  const double largest = u.maxCoeff();
  if (!(largest > 0.0)) {  // a flat body, from its side
    return {0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  }
  const Eigen::Array3d ratio = u / largest;
  const double sum = ratio.pow(p).sum();
  const double extent = largest * std::pow(sum, 1.0 / p);

  SupportValue value;
  value.extent = extent;
  const Eigen::Array3d by_u = (u / extent).pow(p - 1.0);
  value.by_log_half_axes = by_u * u;
  // d u_i / d m_j = s_i (m_i [i = j] + e^2 m_j) / rounded_i
  const Eigen::Array3d by_squares = (rounded > 0.0).select(by_u * half_axes.array() / rounded, 0.0);
  value.contact = (by_squares * direction_in_object.array()).matrix() +
                  by_squares.sum() * rounding * rounding * direction_in_object;
  const Eigen::Array3d log_ratio = (u > 0.0).select((u / extent).log(), 0.0);
  const double by_exponent_of_norm = extent / p * ((u / extent).pow(p) * log_ratio).sum();
  const double by_rounding = by_squares.sum() * rounding * squared_length;
  value.by_shape_exponent = by_exponent_of_norm - kEdgeRounding * by_rounding;
  return value;
}

}  // namespace soslam
