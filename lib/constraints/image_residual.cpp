// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/image_residual.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace soslam {
namespace {

// Pivots of the information below this share of the largest one are rounding errors of zero.
constexpr double kMinPivotShare = 1e-13;

}  // namespace

// With P H P^T = L D L^T, R is sqrt(D) L^T P.
bool ImageResidual::Evaluate(double const* const* blocks, double* residuals,
                             double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponents_);
  Eigen::Map<Eigen::Matrix<double, kLandmarkDof + 1, 1>> values(residuals);
  values.setZero();
  double& rest = residuals[kLandmarkDof];
  if (jacobians == nullptr) {
    rest = std::sqrt(2.0 * in_camera_->Value(observation.landmark_in_camera()));
    return std::isfinite(rest);
  }
  LandmarkModel model;
  in_camera_->AddTo(observation.landmark_in_camera(), &model);
  if (!std::isfinite(model.cost) || !model.gradient.allFinite() || !model.information.allFinite()) {
    return false;
  }
  const Eigen::LDLT<LandmarkModel::Matrix> factor(model.information);
  const LandmarkModel::Vector pivots = factor.vectorD();
  LandmarkModel::Matrix rows = factor.transpositionsP() * LandmarkModel::Matrix::Identity();
  rows = factor.matrixU() * rows;
  LandmarkModel::Vector gradient = factor.transpositionsP() * model.gradient;
  factor.matrixL().solveInPlace(gradient);
  Eigen::Matrix<double, kLandmarkDof + 1, kLandmarkDof> d_landmark;
  d_landmark.setZero();
  for (int i = 0; i < kLandmarkDof; ++i) {
    if (!(pivots[i] > kMinPivotShare * pivots.maxCoeff())) continue;
    values[i] = gradient[i] / std::sqrt(pivots[i]);
    d_landmark.row(i) = std::sqrt(pivots[i]) * rows.row(i);
  }
  rest = std::sqrt(std::max(0.0, 2.0 * model.cost - values.squaredNorm()));
  observation.WriteJacobians<kLandmarkDof + 1>(d_landmark, blocks, jacobians);
  return true;
}

}  // namespace soslam
