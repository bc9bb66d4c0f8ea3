// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/ratio_cost_term.h"

#include <cmath>
#include <limits>

#include "constraints/tangent_space.h"

namespace soslam {

RatioCostTerm::RatioCostTerm(int landmark, const double* landmark_in_world, const ShapePrior& prior)
    : Term({landmark}), landmark_in_world_(landmark_in_world), rows_(prior) {}

Eigen::Vector2d RatioCostTerm::Residuals() const {
  return rows_.Residuals(Eigen::Vector3d(landmark_in_world_ + kPoseSize));
}

double RatioCostTerm::Cost() const { return Linearise(Hessian::kFar, TermPlaces()); }

double RatioCostTerm::Linearise(Hessian /*hessian*/, const TermPlaces& places) const {
  const Eigen::Vector2d residuals = Residuals();
  const double cost = 0.5 * residuals.squaredNorm();
  if (!std::isfinite(cost)) return std::numeric_limits<double>::infinity();
  if (places.gradient[0] == nullptr) return cost;
  Eigen::Map<Eigen::Matrix<double, kLandmarkDof, 1>>(places.gradient[0]).tail<3>() +=
      rows_.by_log_half_axes.transpose().lazyProduct(residuals);
  Eigen::Map<Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>>(places.hessian[0][0])
      .bottomRightCorner<3, 3>() += rows_.information;
  return cost;
}

}  // namespace soslam
