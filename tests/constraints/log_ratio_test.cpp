// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/log_ratio.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

Eigen::Vector2d Residuals(const Eigen::Vector2d& ratio, const Eigen::Vector3d& half_axes) {
  const LandmarkBlock block = Pack(Landmark{RandomRigid(), half_axes});
  const double* blocks[] = {block.data()};
  Eigen::Vector2d values = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(LogRatioResidual(ratio, {0.1, 0.5}).Evaluate(blocks, values.data(), nullptr));
  return values;
}

TEST(LogRatioResidual, WorkedByHand) {
  const Eigen::Vector2d expected(std::log(3.0 / 2.0) / 0.1, std::log(5.0 / 2.0 / 3.0) / 0.5);
  EXPECT_LT((Residuals({1.0, 3.0}, {3.0, 5.0, 2.0}) - expected).norm(), 1e-12);
}

TEST(LogRatioResidual, DoesNotChangeWithSizeAndTreatsBothSidesAlike) {
  const Eigen::Vector3d half_axes = RandomVector(0.1, 2.0);
  EXPECT_LT((Residuals({1.2, 0.7}, half_axes) - Residuals({1.2, 0.7}, 37.0 * half_axes)).norm(),
            1e-12);
  EXPECT_LT((Residuals({1, 1}, {2, 2, 1}) + Residuals({1, 1}, {0.5, 0.5, 1})).norm(), 1e-12);
}

TEST(LogRatioResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const LandmarkBlock block = Pack(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    ExpectCorrectJacobians(LogRatioResidual({1.4, 0.8}, {0.3, 0.1}), {block.data()});
  }
}

}  // namespace
}  // namespace soslam
