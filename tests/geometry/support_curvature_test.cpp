// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_curvature.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/random.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

// Differences of the first derivatives over 1e-6, off the kinks, whose scale is a thousandth.
TEST(SupportCurvature, AgreesWithDifferences) {
  constexpr double kStep = 1e-6;
  for (const double p : kShapeExponents) {
    for (int trial = 0; trial < 50; ++trial) {
      const Eigen::Vector3d half_axes = RandomVector(0.1, 1.0);
      const Eigen::Vector3d direction = RandomVector(-2.0, 2.0);
      if (direction.cwiseAbs().minCoeff() < 0.1) continue;
      const SupportCurvature curvature =
          CurvatureOfSupport(half_axes, p, direction, SupportFunction(half_axes, p, direction));
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
        const SupportValue after = SupportFunction(half_axes, p, direction + step);
        const SupportValue before = SupportFunction(half_axes, p, direction - step);
        EXPECT_LT((curvature.by_direction.col(i) - (after.contact - before.contact) / (2.0 * kStep))
                      .norm(),
                  1e-6);
        EXPECT_LT((curvature.mixed.col(i) -
                   (after.by_log_half_axes - before.by_log_half_axes) / (2.0 * kStep))
                      .norm(),
                  1e-6);
        const Eigen::Vector3d larger = half_axes.array() * step.array().exp();
        const Eigen::Vector3d smaller = half_axes.array() * (-step).array().exp();
        EXPECT_LT((curvature.by_log_half_axes.col(i) -
                   (SupportFunction(larger, p, direction).by_log_half_axes -
                    SupportFunction(smaller, p, direction).by_log_half_axes) /
                       (2.0 * kStep))
                      .norm(),
                  1e-6);
      }
    }
  }
}

// h(m) is convex and homogeneous: its curvature is positive semidefinite and vanishes along m, on a
// kink, too.
TEST(SupportCurvature, IsPositiveSemidefiniteAndVanishesAlongTheDirection) {
  for (const double p : kShapeExponents) {
    for (const double across : {0.0, 1e-4, 0.3}) {
      const Eigen::Vector3d half_axes = RandomVector(0.1, 1.0);
      const Eigen::Vector3d direction(1.0, -0.4, across);
      const SupportValue value = SupportFunction(half_axes, p, direction);
      const SupportCurvature both = CurvatureOfSupport(half_axes, p, direction, value);
      const Eigen::Matrix3d& curvature = both.by_direction;
      EXPECT_TRUE(curvature.isApprox(curvature.transpose(), 1e-12));
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(curvature);
      EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-10 * curvature.norm());
      EXPECT_LT((curvature * direction).norm(), 1e-9 * curvature.norm());
      // d h / d s is homogeneous, too.
      EXPECT_LT((both.mixed * direction - value.by_log_half_axes).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace soslam
