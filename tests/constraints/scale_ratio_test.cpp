// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/constraints/quadric_constraints.h"
#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

Eigen::Vector2d Residuals(const Eigen::Vector2d& ratio, const Eigen::Vector3d& half_axes) {
  return ResidualsAt(ScaleRatioResidual(ratio, 4.0),
                     {ToParameterBlock(Landmark{RandomRigid(), half_axes}).data()});
}

TEST(ScaleRatioResidual, WorkedByHand) {
  const Eigen::Vector2d expected((3.0 / 2.0 - 1.0) / 2.0, (5.0 / 2.0 - 3.0) / 2.0);
  EXPECT_LT((Residuals({1.0, 3.0}, {3.0, 5.0, 2.0}) - expected).norm(), 1e-12);
}

TEST(ScaleRatioResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const LandmarkBlock block = ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    ExpectCorrectJacobians(ScaleRatioResidual({1.4, 0.8}, 0.3), {block.data()});
  }
}

}  // namespace
}  // namespace soslam
