// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/tangencies_at_yaw.h"

#include <cmath>

namespace soslam {

namespace {

SupportInDirections::Rows NormalsInObject(const BoxOnGround& box, double yaw) {
  const double cosine = std::cos(yaw);
  const double sine = std::sin(yaw);
  SupportInDirections::Rows rows;
  rows << cosine * box.normals.col(0) + sine * box.normals.col(1),
      cosine * box.normals.col(1) - sine * box.normals.col(0), box.normals.col(2);
  return rows;
}

}  // namespace

TangenciesAtYaw::TangenciesAtYaw(const BoxOnGround& box, const Eigen::Array4d& depths_m, double yaw,
                                 double shape_exponent)
    : box_(box),
      weights_((depths_m * box.sigma_px).inverse()),
      support_(shape_exponent, NormalsInObject(box, yaw)) {
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
  SupportInDirections::Values support = support_.Of(half_axes);
  const Eigen::Array4d by_height = box_.normals.col(2).array() * half_axes.z();
  support.by_log_half_axes.col(2) += by_height;
  return {weights_ * (box_.at_origin + by_height + support.extents),
          support.by_log_half_axes.colwise() * weights_};
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
