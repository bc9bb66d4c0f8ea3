// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

namespace soslam {

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

}  // namespace soslam
