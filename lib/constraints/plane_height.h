// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/parameters.h"
#include "model/sequence.h"

namespace soslam {

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
