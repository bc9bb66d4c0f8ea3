// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <memory>

#include "constraints/parameters.h"
#include "model/sequence.h"

namespace soslam {

// Prior on a plane's unit normal n, known before boxes are used: its cost is n^T information n / 2
// (positive semidefinite, 1 / rad^2). Residuals: 3, the information's square root times n. Block:
// the normal.
std::unique_ptr<ceres::CostFunction> PlaneNormalPrior(const Eigen::Matrix3d& information);

// Prior on a plane's height at a point p, known before boxes are used. Residual: (side n . p + d) /
// sigma. Blocks: the normal n that parallel planes share, and the offset d. `side` is -1 for a
// plane whose normal is opposite to the block, else 1.
class PlaneHeightResidual final : public ceres::SizedCostFunction<1, kNormalSize, kOffsetSize> {
 public:
  PlaneHeightResidual(const HeightPrior& prior, double side) : prior_(prior), side_(side) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  HeightPrior prior_;
  double side_;
};

}  // namespace soslam
