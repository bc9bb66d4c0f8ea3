// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/parameters.h"

namespace soslam {

// What is known of a plane's unit normal n before boxes are looked at: half n^T information n is
// its cost (1 / rad^2). Residuals: 3, the information's square root times n. Block: the normal.
class AttitudeResidual final : public ceres::SizedCostFunction<3, kNormalSize> {
 public:
  // Of a positive semidefinite matrix.
  explicit AttitudeResidual(const Eigen::Matrix3d& information);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::Matrix3d root_;
};

}  // namespace soslam
