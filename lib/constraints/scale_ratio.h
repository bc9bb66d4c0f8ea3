// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "constraints/parameters.h"

namespace soslam {

// Scale ratio constraint, eq. (9)-(11): (a / c, b / c) equals the label's entry in the semantic
// table. Divided by the square root of the variance; no unit.
//
// Residuals: 2. Block: landmark (any frame).
class ScaleRatioResidual final : public ceres::SizedCostFunction<2, kLandmarkSize> {
 public:
  // `ratio` = (a / c, b / c) > 0; `variance` is the paper's Sigma_ssc.
  ScaleRatioResidual(const Eigen::Vector2d& ratio, double variance);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector2d ratio_;
  double weight_;
};

}  // namespace soslam
