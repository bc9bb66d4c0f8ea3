// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "constraints/manifolds.h"
#include "constraints/parameters.h"

namespace soslam {

// Checks a residual's Jacobians, in the tangent spaces of its pose and landmark blocks, against
// Ridders' numeric derivatives. The tolerance is relative: Ridders' method is good to about 1e-9,
// 1e-6 leaves room for residuals that are small differences of large terms.
inline void ExpectCorrectJacobians(const ceres::CostFunction& residual,
                                   const std::vector<const double*>& blocks,
                                   double tolerance = 1e-6) {
  std::vector<std::unique_ptr<ceres::Manifold>> owned;
  std::vector<const ceres::Manifold*> manifolds;
  for (const int size : residual.parameter_block_sizes()) {
    owned.emplace_back(size == kPoseSize ? NewPoseManifold() : NewLandmarkManifold());
    manifolds.push_back(owned.back().get());
  }
  const ceres::GradientChecker checker(&residual, &manifolds, ceres::NumericDiffOptions());
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(blocks.data(), tolerance, &results)) << results.error_log;
}

}  // namespace soslam
