// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/landmark_cost.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "soslam/base/levenberg_marquardt.h"

namespace soslam {
namespace {

// Pivots of the information below this share of the largest one are rounding errors of zero.
constexpr double kMinPivotShare = 1e-13;

using FewResiduals = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, LandmarkTerm::kMaxResiduals>;

}  // namespace

double LandmarkTerm::Value(const Landmark& landmark) const {
  FewResiduals residuals(NumResiduals());
  Evaluate(landmark, residuals, nullptr);
  return 0.5 * residuals.squaredNorm();
}

void LandmarkTerm::AddTo(const Landmark& landmark, LandmarkModel* sum) const {
  FewResiduals residuals(NumResiduals());
  Jacobian jacobian(NumResiduals(), kLandmarkDof);
  Evaluate(landmark, residuals, &jacobian);
  for (Eigen::Index row = 0; row < residuals.size(); ++row) {
    sum->Add(residuals[row], jacobian.row(row).transpose());
  }
}

double ConstantCost(const LandmarkCosts& costs) {
  double sum = 0.0;
  for (const auto& cost : costs) sum += cost->ConstantCost();
  return sum;
}

double TotalCost(const LandmarkCosts& costs, const Landmark& landmark) {
  double sum = ConstantCost(costs);
  for (const auto& cost : costs) sum += cost->Value(landmark);
  return sum;
}

LandmarkModel LineariseCosts(const LandmarkCosts& costs, const Landmark& landmark) {
  LandmarkModel sum;
  for (const auto& cost : costs) cost->AddTo(landmark, &sum);
  return sum;
}

double NegligibleDecrease(const LandmarkCosts& costs) {
  // Where convergence is slow, the last steps would take most of the time. A step that is left out
  // changes the likelihood by about a thousandth at a cost of 100, by less at a lower one.
  constexpr double kNegligibleDecreaseWhereSlow = 1e-5;
  const bool is_slow =
      std::ranges::any_of(costs, [](const auto& cost) { return cost->ConvergesSlowly(); });
  return is_slow ? kNegligibleDecreaseWhereSlow : kNegligibleDecrease;
}

ViewCost::ViewCost(std::unique_ptr<const LandmarkCost> in_camera,
                   const Rigid3d& camera_from_reference, double weight)
    : in_camera_(std::move(in_camera)),
      camera_from_reference_(camera_from_reference),
      weight_(weight) {}

double ViewCost::Value(const Landmark& landmark_in_reference) const {
  return weight_ * in_camera_->Value(Transform(camera_from_reference_, landmark_in_reference));
}

void ViewCost::AddTo(const Landmark& landmark_in_reference, LandmarkModel* sum) const {
  LandmarkModel in_camera;
  in_camera_->AddTo(Transform(camera_from_reference_, landmark_in_reference), &in_camera);
  sum->Add(in_camera.Chained(
               LandmarkInCameraJacobian(camera_from_reference_.rotation.toRotationMatrix())),
           weight_);
}

Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> LandmarkInCameraJacobian(
    const Eigen::Matrix3d& rotation_camera_from_reference) {
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> jacobian;
  jacobian.setIdentity();
  jacobian.block<3, 3>(0, 0) = rotation_camera_from_reference;
  jacobian.block<3, 3>(3, 3) = rotation_camera_from_reference;
  return jacobian;
}

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
