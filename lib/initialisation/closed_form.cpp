// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <Eigen/QR>
#include <cmath>

#include "geometry/support_function.h"

namespace soslam {
namespace {

// Each round reduces the error of the tangent depths by a factor of 100 or more.
constexpr int kMaxDepthRounds = 20;
constexpr double kDepthTolerance = 1e-10;

}  // namespace

BoxOnGround::BoxOnGround(const std::array<BoxEdge, 4>& edges, const UprightGround& ground) {
  Eigen::Matrix3d camera_from_ground;
  camera_from_ground << ground.x, ground.y, ground.normal;
  const Eigen::Vector3d& origin = ground.origin;
  for (int i = 0; i < 4; ++i) {
    const BoxEdge& edge = edges[static_cast<size_t>(i)];
    normals.row(i) = edge.plane.transpose() * camera_from_ground;
    at_origin[i] = edge.plane.dot(origin);
    sigma_px[i] = edge.sigma_px;
    is_bound[i] = edge.is_bound ? 1.0 : 0.0;
  }
  optical_axis = camera_from_ground.row(2);
  origin_depth = origin.z();
}

ClosedForm::ClosedForm(const UprightObservation& observation)
    : box_(observation.edges, UprightGround(observation.plane_in_camera)),
      proportions_(observation.prior.ratio.x(), observation.prior.ratio.y(), 1.0),
      shape_exponent_(observation.prior.shape_exponent) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>> of_foot(box_.normals.leftCols<2>());
  const Eigen::Matrix4d orthonormal = of_foot.householderQ();
  without_foot_ = orthonormal.rightCols<2>();
  foot_by_b_ = of_foot.matrixQR().topRows<2>().triangularView<Eigen::Upper>().solve(
      orthonormal.leftCols<2>().transpose());
}

ClosedForm::HalfHeightCoefficients ClosedForm::CoefficientsAt(const Heading& heading) const {
  const Eigen::Vector3d axis = heading.ToObjectFrame(box_.optical_axis);
  HalfHeightCoefficients coefficients;
  for (int edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d normal = heading.ToObjectFrame(box_.normals.row(edge));
    const SupportValue support = SupportFunction(proportions_, shape_exponent_, normal);
    coefficients.residuals[edge] = normal.z() + support.extent;
    coefficients.tangent_depths[edge] = axis.z() + axis.dot(support.contact);
  }
  coefficients.nearest_depth =
      axis.z() - SupportFunction(proportions_, shape_exponent_, axis).extent;
  return coefficients;
}

std::optional<ClosedFormSolution> ClosedForm::At(double yaw) const {
  if (!HasEnoughEdges()) return std::nullopt;
  const HalfHeightCoefficients coefficients = CoefficientsAt(Heading(yaw));
  const Eigen::Vector2d projected = without_foot_.transpose() * coefficients.residuals.matrix();
  const Eigen::Array4d half_height_by_b = without_foot_ * projected / projected.squaredNorm();
  const Eigen::Array4d null = without_foot_ * Eigen::Vector2d(-projected.y(), projected.x());
  const double missing = (null * box_.at_origin).sum();  // n^T r
  const bool has_bound = (box_.is_bound != 0.0).any();
  Eigen::Array4d depths_m = Eigen::Array4d::Ones();  // any value, as long as they are equal
  for (int round = 0;; ++round) {
    Eigen::Array4d residuals = (depths_m * box_.sigma_px).square() * null;
    residuals *= missing / (residuals * null).sum();
    if (has_bound) {
      // Three equations have a solution; then the bound has a residual only if it is reached.
      const double at_bound = missing / (box_.is_bound * null).sum();
      if (!(at_bound < 0.0)) residuals = box_.is_bound * at_bound;
    }
    const Eigen::Array4d b = residuals - box_.at_origin;
    const double half_height = (half_height_by_b * b).sum();
    const Eigen::Vector2d foot = foot_by_b_ * (b - half_height * coefficients.residuals).matrix();
    const double foot_depth_m = box_.origin_depth + box_.optical_axis.head<2>().dot(foot);
    const double nearest_m = foot_depth_m + half_height * coefficients.nearest_depth;
    if (!(half_height > 0.0 && nearest_m > 0.0 && std::isfinite(nearest_m))) return std::nullopt;
    const Eigen::Array4d before = depths_m;
    depths_m = foot_depth_m + half_height * coefficients.tangent_depths;
    const bool is_settled = ((depths_m - before).abs() < kDepthTolerance * depths_m).all();
    if (!is_settled && round + 1 < kMaxDepthRounds) continue;
    ClosedFormSolution solution{UprightVector(), depths_m};
    solution.parameters << yaw, foot, (half_height * proportions_).array().log();
    return solution;
  }
}

}  // namespace soslam
