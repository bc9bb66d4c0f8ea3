// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

namespace soslam {

// Keeps a nuisance parameter near zero: value / sigma. Residuals: 1. Block: the value.
class BiasResidual final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit BiasResidual(double sigma) : weight_(1.0 / sigma) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    residuals[0] = weight_ * blocks[0][0];
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = weight_;
    return true;
  }

 private:
  double weight_;
};

}  // namespace soslam
