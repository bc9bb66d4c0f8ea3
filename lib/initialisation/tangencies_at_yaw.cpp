// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/tangencies_at_yaw.h"

#include <cmath>

namespace soslam {

TangenciesAtYaw::TangenciesAtYaw(const BoxOnGround& box, const Eigen::Array4d& depths_m, double yaw,
                                 double shape_exponent)
    : box_(box), shape_exponent_(shape_exponent), weights_((depths_m * box.sigma_px).inverse()) {
  const double cosine = std::cos(yaw);
  const double sine = std::sin(yaw);
  for (size_t i = 0; i < in_object_.size(); ++i) {
    in_object_[i] = TurnedBack(box.normals.row(static_cast<Eigen::Index>(i)), cosine, sine);
  }
  // Gram and Schmidt's orthonormal basis of two columns.
  const Eigen::Vector4d by_x = weights_ * box.normals.col(0).array();
  const Eigen::Vector4d by_y = weights_ * box.normals.col(1).array();
  foot_triangle_(0, 0) = by_x.norm();
  foot_basis_.col(0) = by_x / foot_triangle_(0, 0);
  foot_triangle_(0, 1) = foot_basis_.col(0).dot(by_y);
  const Eigen::Vector4d rest = by_y - foot_triangle_(0, 1) * foot_basis_.col(0);
  foot_triangle_(1, 1) = rest.norm();
  foot_basis_.col(1) = rest / foot_triangle_(1, 1);
}

bool TangenciesAtYaw::TellTheFoot() const {
  constexpr double kLeastShare = 1e-6;
  const double one = foot_triangle_(0, 0);
  const double other = foot_triangle_(1, 1);
  return one > kLeastShare * other && other > kLeastShare * one;
}

TangenciesAtYaw::Rows TangenciesAtYaw::RowsAtOrigin(const Eigen::Vector3d& log_half_axes) const {
  const Eigen::Vector3d half_axes = log_half_axes.array().exp();
  Rows rows;
  for (int i = 0; i < 4; ++i) {
    const SupportValue support =
        SupportFunction(half_axes, shape_exponent_, in_object_[static_cast<size_t>(i)]);
    const double by_height = box_.normals(i, 2) * half_axes.z();
    rows.residuals[i] = weights_[i] * (box_.at_origin[i] + by_height + support.extent);
    rows.by_log_half_axes.row(i) = weights_[i] * support.by_log_half_axes;
    rows.by_log_half_axes(i, 2) += weights_[i] * by_height;
  }
  return rows;
}

QuadraticModel<3> TangenciesAtYaw::Evaluate(const Eigen::Vector3d& log_half_axes) const {
  const Rows rows = RowsAtOrigin(log_half_axes);
  const Eigen::Vector2d foot = foot_basis_.transpose().lazyProduct(rows.residuals);
  const Eigen::Matrix<double, 2, 3> foot_by_log_half_axes =
      foot_basis_.transpose().lazyProduct(rows.by_log_half_axes);
  const Eigen::Vector4d residuals = rows.residuals - foot_basis_.lazyProduct(foot);
  QuadraticModel<3> model;
  model.cost = 0.5 * residuals.squaredNorm();
  model.gradient = rows.by_log_half_axes.transpose().lazyProduct(residuals);
  model.information = rows.by_log_half_axes.transpose().lazyProduct(rows.by_log_half_axes) -
                      foot_by_log_half_axes.transpose().lazyProduct(foot_by_log_half_axes);
  return model;
}

Eigen::Vector2d TangenciesAtYaw::BestFoot(const Eigen::Vector3d& log_half_axes) const {
  const Eigen::Vector2d foot = foot_basis_.transpose() * RowsAtOrigin(log_half_axes).residuals;
  return -foot_triangle_.triangularView<Eigen::Upper>().solve(foot);
}

}  // namespace soslam
