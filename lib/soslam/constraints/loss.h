// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

#include <cmath>

namespace soslam {

// The loss of Geman and McClure, rho(r^2) = r^2 / (1 + r^2 / scale^2): bounded by scale^2.
class GemanMcClureLoss final : public ceres::LossFunction {
 public:
  explicit GemanMcClureLoss(double scale) : squared_scale_(scale * scale) {}
  void Evaluate(double squared_residual, double rho[3]) const override {
    const double share = 1.0 / (1.0 + squared_residual / squared_scale_);
    rho[0] = squared_residual * share;
    rho[1] = share * share;
    rho[2] = -2.0 * share * share * share / squared_scale_;
  }

 private:
  double squared_scale_;
};

// A residual's cost under a loss, and its weight in iteratively reweighted least squares.
struct RobustCost {
  double cost;    // half of rho(r^2)
  double weight;  // rho'(r^2)
};
inline RobustCost EvaluateLoss(const ceres::LossFunction& loss, double residual) {
  double rho[3];
  loss.Evaluate(residual * residual, rho);
  return {0.5 * rho[0], rho[1]};
}

// The loss as a residual of its own: half the square of `value` is the cost.
struct RobustResidual {
  double value;
  double slope;  // d value / d residual
};
inline RobustResidual RobustifyResidual(const ceres::LossFunction& loss, double residual) {
  const RobustCost robust = EvaluateLoss(loss, residual);
  const double value = std::copysign(std::sqrt(2.0 * robust.cost), residual);
  return {value, value == 0.0 ? 1.0 : robust.weight * residual / value};
}

}  // namespace soslam
