// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

#include "geometry/support_function.h"

namespace soslam {
namespace {

// Each round reduces the error of the tangent depths by a factor of 100 or more.
constexpr int kMaxDepthRounds = 20;
constexpr double kDepthTolerance = 1e-10;

}  // namespace

ClosedForm::ClosedForm(const UprightObservation& observation)
    : proportions_(observation.prior.ratio.x(), observation.prior.ratio.y(), 1.0),
      shape_exponents_(observation.prior.shape_exponents) {
  const UprightGround ground(observation.plane_in_camera);
  Eigen::Matrix3d camera_from_ground;
  camera_from_ground << ground.x, ground.y, ground.normal;
  for (int i = 0; i < 4; ++i) {
    const BoxEdge& edge = observation.edges[i];
    normals_.row(i) = edge.plane.transpose() * camera_from_ground;
    at_origin_[i] = edge.plane.dot(ground.origin);
    sigma_px_[i] = edge.sigma_px;
    is_one_sided_[i] = edge.is_one_sided ? 1.0 : 0.0;
  }
  optical_axis_ = camera_from_ground.row(2);
  origin_depth_ = ground.origin.z();
  const Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>> of_foot(normals_.leftCols<2>());
  const Eigen::Matrix4d orthonormal = of_foot.householderQ();
  without_foot_ = orthonormal.rightCols<2>();
  foot_by_b_ = of_foot.matrixQR().topRows<2>().triangularView<Eigen::Upper>().solve(
      orthonormal.leftCols<2>().transpose());
}

ClosedForm::HalfHeightCoefficients ClosedForm::CoefficientsAt(double yaw) const {
  Eigen::Matrix3d object_from_ground = Eigen::Matrix3d::Identity();
  object_from_ground.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-yaw).toRotationMatrix();
  const Eigen::Vector3d axis = object_from_ground * optical_axis_;
  HalfHeightCoefficients coefficients;
  for (int edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d normal = object_from_ground * normals_.row(edge).transpose();
    const SupportValue support = SupportFunction(proportions_, shape_exponents_, normal);
    coefficients.residuals[edge] = normal.z() + support.extent;
    coefficients.tangent_depths[edge] = axis.z() + axis.dot(support.point);
  }
  coefficients.nearest_depth =
      axis.z() - SupportFunction(proportions_, shape_exponents_, axis).extent;
  return coefficients;
}

std::optional<UprightVector> ClosedForm::At(double yaw) const {
  if (!HasEnoughEdges()) return std::nullopt;
  const HalfHeightCoefficients coefficients = CoefficientsAt(yaw);
  const Eigen::Vector2d projected = without_foot_.transpose() * coefficients.residuals.matrix();
  const Eigen::Array4d half_height_by_b = without_foot_ * projected / projected.squaredNorm();
  const Eigen::Array4d null = without_foot_ * Eigen::Vector2d(-projected.y(), projected.x());
  const double missing = (null * at_origin_).sum();  // n^T r
  const bool has_one_sided = (is_one_sided_ != 0.0).any();
  Eigen::Array4d depths_m = Eigen::Array4d::Ones();  // any value, as long as they are equal
  for (int round = 0;; ++round) {
    Eigen::Array4d residuals = (depths_m * sigma_px_).square() * null;
    residuals *= missing / (residuals * null).sum();
    if (has_one_sided) {
      // Three equations have a solution; then the one-sided edge has a residual only if it is
      // reached.
      const double at_one_sided = missing / (is_one_sided_ * null).sum();
      if (!(at_one_sided < 0.0)) residuals = is_one_sided_ * at_one_sided;
    }
    const Eigen::Array4d b = residuals - at_origin_;
    const double half_height = (half_height_by_b * b).sum();
    const Eigen::Vector2d foot = foot_by_b_ * (b - half_height * coefficients.residuals).matrix();
    const double foot_depth_m = origin_depth_ + optical_axis_.head<2>().dot(foot);
    const double nearest_m = foot_depth_m + half_height * coefficients.nearest_depth;
    if (!(half_height > 0.0 && nearest_m > 0.0 && std::isfinite(nearest_m))) return std::nullopt;
    const Eigen::Array4d before = depths_m;
    depths_m = foot_depth_m + half_height * coefficients.tangent_depths;
    const bool is_settled = ((depths_m - before).abs() < kDepthTolerance * depths_m).all();
    if (!is_settled && round + 1 < kMaxDepthRounds) continue;
    UprightVector solution;
    solution << yaw, foot, (half_height * proportions_).array().log();
    return solution;
  }
}

}  // namespace soslam
