// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_curvature.h"

namespace soslam {
namespace {

SupportCurvature OfEllipsoid(const Eigen::Vector3d& half_axes, const SupportValue& value) {
  const double less = 1.0 / value.extent;
  const Eigen::Vector3d contact = less * value.contact;
  SupportCurvature curvature;
  curvature.by_direction = -contact * value.contact.transpose();
  curvature.by_direction.diagonal() += less * half_axes.cwiseAbs2();
  curvature.mixed = -value.by_log_half_axes * contact.transpose();
  curvature.mixed.diagonal() += 2.0 * value.contact;
  curvature.by_log_half_axes = -less * value.by_log_half_axes * value.by_log_half_axes.transpose();
  curvature.by_log_half_axes.diagonal() += 2.0 * value.by_log_half_axes;
  return curvature;
}

}  // namespace

// With r_i = sqrt(m_i^2 + e^2 |m|^2), its gradient g_i, l_i = dh / ds_i and c = dh / dm:
//   by m:      sum_i l_i / r_i^2 (e_i e_i^T + e^2 I - (2 - p) g_i g_i^T) - (p - 1) / h c c^T
//   by s, m:   p l_i / r_i g_i^T - (p - 1) / h l_i c^T
//   by s:      p diag(l) - (p - 1) / h l l^T
SupportCurvature CurvatureOfSupport(const Eigen::Vector3d& half_axes, double shape_exponent,
                                    const Eigen::Vector3d& direction_in_object,
                                    const SupportValue& value) {
  const Eigen::Vector3d& m = direction_in_object;
  const Eigen::Vector3d& by_log = value.by_log_half_axes;
  const double p = shape_exponent;
  const double rounding = kEdgeRounding * (kEllipsoidExponent - p);
  const double e2 = rounding * rounding;
  SupportCurvature curvature;
  if (!(value.extent > 0.0)) {  // a flat body, from its side
    curvature.by_direction.setZero();
    curvature.mixed.setZero();
    curvature.by_log_half_axes.setZero();
    return curvature;
  }
  if (p == kEllipsoidExponent) return OfEllipsoid(half_axes, value);
  const double less = (p - 1.0) / value.extent;
  curvature.by_direction = -less * value.contact * value.contact.transpose();
  curvature.mixed = -less * by_log * value.contact.transpose();
  curvature.by_log_half_axes = -less * by_log * by_log.transpose();
  curvature.by_log_half_axes.diagonal() += p * by_log;
  for (int i = 0; i < 3; ++i) {
    const double inverse_square = 1.0 / (m[i] * m[i] + e2 * m.squaredNorm());
    Eigen::Vector3d by_direction = e2 * m;  // r_i g_i
    by_direction[i] += m[i];
    const double k = by_log[i] * inverse_square;
    curvature.by_direction(i, i) += k;
    curvature.by_direction.diagonal().array() += k * e2;
    curvature.by_direction -=
        (2.0 - p) * k * inverse_square * by_direction * by_direction.transpose();
    curvature.mixed.row(i) += p * k * by_direction.transpose();
  }
  return curvature;
}

}  // namespace soslam
