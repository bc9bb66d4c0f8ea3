// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/landmark_terms.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "soslam/constraints/loss.h"
#include "soslam/constraints/parameters.h"

namespace soslam {

RatioRows::RatioRows(const ShapePrior& prior) {
  const double correlation = prior.log_correlation;
  const double unexplained = std::sqrt(1.0 - correlation * correlation);
  Eigen::Matrix2d whiten;
  whiten << 1.0, 0.0, -correlation / unexplained, 1.0 / unexplained;
  whiten *= prior.log_sigma.cwiseInverse().asDiagonal();
  d_log_half_axes << whiten, -whiten.rowwise().sum();
  at_prior = whiten * prior.ratio.array().log().matrix();
}

void RatioTerm::Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const {
  residuals = rows_.Residuals(landmark.half_axes.array().log());
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->rightCols<3>() = rows_.d_log_half_axes;
}

void LengthTerm::Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const {
  const auto& [length_m, axis] = length_;
  residuals[0] = LengthResidual(length_m, landmark.half_axes[axis]);
  if (jacobian == nullptr) return;
  jacobian->setZero();
  (*jacobian)(0, 6 + axis) = 1.0 / length_m.log_sigma;
}

void RobustViewTerm::Evaluate(const Landmark& landmark_in_reference, Residuals residuals,
                              Jacobian* jacobian) const {
  term_->Evaluate(Transform(camera_from_reference_, landmark_in_reference), residuals, jacobian);
  if (jacobian != nullptr) {
    *jacobian *= LandmarkInCameraJacobian(camera_from_reference_.rotation.toRotationMatrix());
  }
  const ceres::HuberLoss loss(huber_delta_);
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    const RobustResidual robust = RobustifyResidual(loss, residuals[i]);
    residuals[i] = robust.value;
    if (jacobian != nullptr) jacobian->row(i) *= robust.slope;
  }
  residuals *= root_weight_;
  if (jacobian != nullptr) *jacobian *= root_weight_;
}

AxisTerm::AxisTerm(const Plane& plane, const Eigen::Vector3d& axis, double weight)
    : normal_(plane.normal),
      axis_yaw_(Yaw(normal_, RotationBetween(Eigen::Vector3d::UnitX(), axis))),
      amplitude_(std::sqrt(2.0 * weight)) {}

void AxisTerm::Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const {
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  const double angle = 2.0 * (Yaw(normal_, rotation) - axis_yaw_);
  residuals[0] = amplitude_ * std::sin(angle);
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->leftCols<3>() = 2.0 * amplitude_ * std::cos(angle) * YawJacobian(normal_, rotation);
}

void YawTerm::Evaluate(const Landmark& landmark, Residuals residuals, Jacobian* jacobian) const {
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  residuals[0] = YawDifferenceModuloPi(Yaw(normal_, rotation), prior_.yaw) / prior_.sigma;
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->leftCols<3>() = YawJacobian(normal_, rotation) / prior_.sigma;
}

namespace {

constexpr int kPadding = 2;  // of cubic interpolation

std::vector<double> Padded(const std::vector<double>& costs) {
  std::vector<double> padded(costs.end() - kPadding, costs.end());
  padded.insert(padded.end(), costs.begin(), costs.end());
  padded.insert(padded.end(), costs.begin(), costs.begin() + kPadding);
  return padded;
}

// The lowest value of the interpolation, which is a cubic between the middle two of four values.
double FindLowest(const std::vector<double>& padded) {
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 3 < padded.size(); ++i) {
    const double* values = &padded[i];
    const double slope = 0.5 * (values[2] - values[0]);
    const double square = values[0] - 2.5 * values[1] + 2.0 * values[2] - 0.5 * values[3];
    const double cube = 0.5 * (values[3] - values[0]) + 1.5 * (values[1] - values[2]);
    const double root = std::sqrt(std::max(0.0, square * square - 3.0 * cube * slope));
    const double at = square > 0.0 ? -slope / (square + root) : (root - square) / (3.0 * cube);
    lowest = std::min(lowest, std::min(values[1], values[2]));
    if (!(at > 0.0 && at < 1.0)) continue;
    lowest = std::min(lowest, values[1] + at * (slope + at * (square + at * cube)));
  }
  return lowest;
}

constexpr double kLeast = 1e-8;  // of a cost: the root has no derivative at zero

}  // namespace

YawCostTerm::YawCostTerm(const Plane& plane, const std::vector<double>& costs)
    : normal_(plane.normal),
      padded_(Padded(costs)),
      grid_(padded_.data(), 0, static_cast<int>(padded_.size())),
      interpolator_(grid_),
      raise_(kLeast - std::min(0.0, FindLowest(padded_))) {}

void YawCostTerm::Evaluate(const Landmark& landmark, Residuals residuals,
                           Jacobian* jacobian) const {
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  const double steps = static_cast<double>(padded_.size() - 2 * kPadding) / std::numbers::pi;
  double yaw = Yaw(normal_, rotation);
  if (yaw < 0.0) yaw += std::numbers::pi;
  double cost, slope;
  interpolator_.Evaluate(kPadding + steps * yaw, &cost, &slope);
  residuals[0] = std::sqrt(2.0 * (cost + raise_));
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->leftCols<3>() = slope * steps / residuals[0] * YawJacobian(normal_, rotation);
}

void LeaningTerm::Evaluate(const Landmark& landmark, Residuals residuals,
                           Jacobian* jacobian) const {
  const StandingOnPlane standing(landmark, plane_, sigmas_, /*may_lean=*/true);
  residuals = standing.residuals;
  if (jacobian != nullptr) *jacobian = standing.d_landmark;
}

bool LandmarkTermResidual::Evaluate(double const* const* blocks, double* residuals,
                                    double** jacobians) const {
  const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
  LandmarkTerm::Jacobian d_landmark(num_residuals(), kLandmarkDof);
  term_->Evaluate(UnpackLandmark(blocks[0], shape_exponents_),
                  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()),
                  with_jacobian ? &d_landmark : nullptr);
  if (!Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()).allFinite()) return false;
  if (with_jacobian) {
    if (!d_landmark.allFinite()) return false;
    WriteLandmarkJacobian<Eigen::Dynamic>(blocks[0], d_landmark, jacobians[0]);
  }
  return true;
}

}  // namespace soslam
