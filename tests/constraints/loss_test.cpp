// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/loss.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

TEST(GemanMcClureLoss, HasTheDerivativesOfItsValue) {
  constexpr double kStep = 1e-4;
  const GemanMcClureLoss loss(2.0);
  for (const double squared : {0.1, 1.0, 4.0, 50.0}) {
    double rho[3], above[3], below[3];
    loss.Evaluate(squared, rho);
    loss.Evaluate(squared + kStep, above);
    loss.Evaluate(squared - kStep, below);
    EXPECT_NEAR(rho[1], (above[0] - below[0]) / (2.0 * kStep), 1e-7);
    EXPECT_NEAR(rho[2], (above[1] - below[1]) / (2.0 * kStep), 1e-7);
  }
}

TEST(GemanMcClureLoss, IsTheSquareNearZeroAndBoundedByItsScale) {
  const GemanMcClureLoss loss(2.0);
  EXPECT_NEAR(EvaluateLoss(loss, 1e-4).cost, 0.5e-8, 1e-15);
  EXPECT_NEAR(EvaluateLoss(loss, 1e6).cost, 0.5 * 4.0, 1e-9);
  EXPECT_NEAR(EvaluateLoss(loss, 2.0).cost, 0.5 * 2.0, 1e-12);  // half of the bound at the scale
}

TEST(RobustifyResidual, HasTheCostOfTheLossAndItsOwnDerivative) {
  constexpr double kStep = 1e-6;
  const GemanMcClureLoss geman_mcclure(1.5);
  const ceres::HuberLoss huber(1.5);
  for (const ceres::LossFunction* loss : {static_cast<const ceres::LossFunction*>(&geman_mcclure),
                                          static_cast<const ceres::LossFunction*>(&huber)}) {
    for (const double residual : {-7.0, -1.0, 0.3, 1.2, 4.0}) {
      const RobustResidual robust = RobustifyResidual(*loss, residual);
      EXPECT_NEAR(0.5 * robust.value * robust.value, EvaluateLoss(*loss, residual).cost, 1e-12);
      EXPECT_GT(robust.value * residual, 0.0);
      const double slope = (RobustifyResidual(*loss, residual + kStep).value -
                            RobustifyResidual(*loss, residual - kStep).value) /
                           (2.0 * kStep);
      EXPECT_NEAR(robust.slope, slope, 1e-7);
    }
    EXPECT_EQ(RobustifyResidual(*loss, 0.0).value, 0.0);
    EXPECT_EQ(RobustifyResidual(*loss, 0.0).slope, 1.0);
  }
}

}  // namespace
}  // namespace soslam
