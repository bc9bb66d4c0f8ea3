// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "evaluation/landmark_errors.h"
#include "geometry/rigid3.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(RotationError, HidesTheRotationsOfTheCube) {
  const Eigen::Quaterniond truth = RandomRotation();
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 4; ++z) {
        const Eigen::Quaterniond turned = truth *
                                          Eigen::AngleAxisd(x * kPi / 2, Eigen::Vector3d::UnitX()) *
                                          Eigen::AngleAxisd(y * kPi / 2, Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(z * kPi / 2, Eigen::Vector3d::UnitZ());
        EXPECT_NEAR(RotationError(turned, truth), 0.0, 1e-7);
      }
    }
  }
}

TEST(RotationError, IsTheAngleOfASmallTurn) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond truth = RandomRotation();
    const double angle = RandomUniform(0.0, kPi / 4);
    const Eigen::Vector3d axis = RandomRotation() * Eigen::Vector3d::UnitX();
    const double error = RotationError(ExpRotation(angle * axis) * truth, truth);
    EXPECT_LE(error, angle + 1e-9);
    if (angle < kPi / 4 - 0.05) {
      EXPECT_NEAR(error, angle, 1e-9);
    }
  }
}

// No rotation is further from the cube's group than about 62.8 degrees.
TEST(RotationError, IsBounded) {
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LE(RotationError(RandomRotation(), RandomRotation()), 62.8 * kPi / 180);
  }
}

TEST(YawError, IsModuloHalfATurnButNotAQuarter) {
  const Eigen::Quaterniond truth = RandomRotation();
  const auto turned = [&](double yaw) {
    return Eigen::Quaterniond(truth * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  };
  EXPECT_NEAR(YawError(turned(0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(kPi + 0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(-0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(kPi / 2), truth), kPi / 2, 1e-9);
}

TEST(YawError, OfAnEstimateLyingOnItsFrontIsAQuarterTurn) {
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(YawError(lying, Eigen::Quaterniond::Identity()), kPi / 2, 1e-9);
}

}  // namespace
}  // namespace soslam
