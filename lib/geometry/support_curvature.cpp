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

// With r_i = sqrt(m_i^2 + e^2 |m|^2), its gradient g_i = (m_i e_i + e^2 m) / r_i, l_i = dh / ds_i
// and c = dh / dm:
//   by m:      sum_i l_i / r_i^2 (e_i e_i^T + e^2 I - (2 - p) g_i g_i^T) - (p - 1) / h c c^T
//   by s, m:   p l_i / r_i g_i^T - (p - 1) / h l_i c^T
//   by s:      p diag(l) - (p - 1) / h l l^T
SupportCurvature CurvatureOfSupport(const Eigen::Vector3d& half_axes, double shape_exponent,
                                    const Eigen::Vector3d& direction_in_object,
                                    const SupportValue& value) {
  const Eigen::Vector3d& m = direction_in_object;
  const Eigen::Vector3d& by_log = value.by_log_half_axes;
  const double p = shape_exponent;
  const double e2 = SquaredRounding(p);
  SupportCurvature curvature;
  if (!(value.extent > 0.0)) {  // a flat body, from its side
    curvature.by_direction.setZero();
    curvature.mixed.setZero();
    curvature.by_log_half_axes.setZero();
    return curvature;
  }
  if (p == kEllipsoidExponent) return OfEllipsoid(half_axes, value);
  const double less = (p - 1.0) / value.extent;
  const Eigen::Vector3d inverse_squares =
      (m.array().square() + e2 * m.squaredNorm()).inverse();  // 1 / r^2
  // l / r^2, (2 - p) l / r^4, that times m, and half of what e^2 leaves of g g^T
  const Eigen::Vector3d shares = by_log.cwiseProduct(inverse_squares);
  const Eigen::Vector3d weights = (2.0 - p) * shares.cwiseProduct(inverse_squares);
  const Eigen::Vector3d weighted = weights.cwiseProduct(m);
  const Eigen::Matrix3d half_of_rounding =
      e2 * m * (weighted + 0.5 * e2 * weights.sum() * m).transpose();
  curvature.by_direction = -less * value.contact * value.contact.transpose() - half_of_rounding -
                           half_of_rounding.transpose();
  curvature.by_direction.diagonal() += shares - weighted.cwiseProduct(m);
  curvature.by_direction.diagonal().array() += e2 * shares.sum();
  curvature.mixed = (p * e2 * shares) * m.transpose() - less * by_log * value.contact.transpose();
  curvature.mixed.diagonal() += p * shares.cwiseProduct(m);
  curvature.by_log_half_axes = -less * by_log * by_log.transpose();
  curvature.by_log_half_axes.diagonal() += p * by_log;
  return curvature;
}

}  // namespace soslam
