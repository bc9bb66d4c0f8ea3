// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "constraints/parameters.h"

namespace soslam {

// Scale ratio constraint with the label's own spread: the logarithms of (a / c, b / c) against
// those of the prior, divided by their standard deviations. No unit.
//
// Residuals: 2. Block: landmark (any frame).
class LogRatioResidual final : public ceres::SizedCostFunction<2, kLandmarkSize> {
 public:
  LogRatioResidual(const Eigen::Vector2d& ratio, const Eigen::Vector2d& log_sigma);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector2d log_ratio_;
  Eigen::Vector2d weight_;
};

}  // namespace soslam
