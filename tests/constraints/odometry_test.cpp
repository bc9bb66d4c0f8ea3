// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/odometry.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(OdometryNoise, OfARotationIsAFractionOfItWithinBounds) {
  OdometryNoise noise{.rotation_rad = 0.1, .translation_m = 1.0};
  const auto sigma = [&](double angle) { return noise.RotationSigma(ExpRotation({0, angle, 0})); };
  EXPECT_EQ(sigma(0.0), 0.1);
  EXPECT_EQ(sigma(1.5), 0.1);
  noise.rotation_fraction = 0.2;
  EXPECT_DOUBLE_EQ(sigma(0.0), 0.0025);
  EXPECT_DOUBLE_EQ(sigma(0.01), 0.0025);
  EXPECT_NEAR(sigma(0.3), 0.06, 1e-12);
  EXPECT_EQ(sigma(1.5), 0.1);
}

using Vector6d = Eigen::Matrix<double, 6, 1>;

TEST(OdometryResidual, IsZeroForTheMeasuredMotion) {
  for (int i = 0; i < 100; ++i) {
    const Rigid3d first = RandomRigid();
    const Rigid3d first_from_second = RandomRigid();
    const OdometryResidual residual(first_from_second,
                                    {.rotation_rad = 0.01, .translation_m = 0.02});
    EXPECT_LT(residual.Values(first, first * first_from_second).norm(), 1e-9);
  }
}

// Measured: no motion. Estimated: 0.3 m along x and a turn of 0.2 rad about y.
TEST(OdometryResidual, WorkedByHand) {
  const OdometryResidual residual(Rigid3d(), {.rotation_rad = 0.1, .translation_m = 0.5});
  const Rigid3d second{ExpRotation({0, 0.2, 0}), {0.3, 0, 0}};
  Vector6d expected;
  expected << 0, 2.0, 0, 0.6, 0, 0;
  EXPECT_LT((residual.Values(Rigid3d(), second) - expected).norm(), 1e-12);
}

// Up to 2.8 rad of error; the rotation vector is not smooth at pi.
TEST(OdometryResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Rigid3d first = RandomRigid();
    const Rigid3d first_from_second = RandomRigid();
    const Rigid3d error{
        ExpRotation(RandomVector(-1, 1).normalized() * RandomUniform(0.0, i < 10 ? 1e-6 : 2.8)),
        RandomVector(-0.5, 0.5)};
    const PoseBlock first_block = ToParameterBlock(first);
    const PoseBlock second_block = ToParameterBlock(first * first_from_second * error);
    ExpectCorrectJacobians(
        OdometryResidual(first_from_second, {.rotation_rad = 0.5, .translation_m = 0.3}),
        {first_block.data(), second_block.data()});
  }
}

}  // namespace
}  // namespace soslam
