// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_function.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/shape_exponents.h"

namespace soslam {
namespace {

// Half axes, exponents (each of kShapeExponents, then any) and a direction.
struct RandomCase {
  explicit RandomCase(size_t i)
      : p(i < kShapeExponents.size()
              ? kShapeExponents[i]
              : ShapeExponents(RandomUniform(1.0, 2.0), RandomUniform(1.0, 2.0))) {}

  ShapeExponents p;
  Eigen::Vector3d half_axes = RandomVector(0.1, 1.0);
  Eigen::Vector3d direction = RandomUniform(0.1, 3.0) * RandomDirection();
};

constexpr size_t kCases = 300;

double Extent(const Eigen::Vector3d& half_axes, const ShapeExponents& p,
              const Eigen::Vector3d& direction) {
  return SupportFunction(half_axes, p, direction).extent;
}

TEST(SupportFunction, DerivativesAgreeWithNumbers) {
  constexpr double kStep = 1e-6;
  for (size_t i = 0; i < kCases; ++i) {
    RandomCase random(i);
    // Off the rounded kinks, where second derivatives are up to 1 / kEdgeRounding.
    random.direction = random.direction.array().sign() * (0.1 + random.direction.array().abs());
    const auto& [p, half_axes, direction] = random;
    const SupportValue value = SupportFunction(half_axes, p, direction);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      EXPECT_NEAR(
          value.point[k],
          (Extent(half_axes, p, direction + step) - Extent(half_axes, p, direction - step)) /
              (2 * kStep),
          1e-8)
          << p;
      const Eigen::Vector3d larger = half_axes.array() * step.array().exp();
      const Eigen::Vector3d smaller = half_axes.array() * (-step).array().exp();
      EXPECT_NEAR(value.d_log_half_axes[k],
                  (Extent(larger, p, direction) - Extent(smaller, p, direction)) / (2 * kStep),
                  1e-8)
          << p;
    }
  }
}

TEST(SupportHessian, IsTheDerivativeOfTheSupportPoint) {
  constexpr double kStep = 1e-6;
  for (size_t i = 0; i < kCases; ++i) {
    RandomCase random(i);
    random.direction = random.direction.array().sign() * (0.1 + random.direction.array().abs());
    const auto& [p, half_axes, direction] = random;
    const Eigen::Matrix3d hessian = SupportHessian(half_axes, p, direction);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d numeric = (SupportFunction(half_axes, p, direction + step).point -
                                       SupportFunction(half_axes, p, direction - step).point) /
                                      (2 * kStep);
      EXPECT_LT((hessian.col(k) - numeric).norm(), 1e-7) << p;
    }
  }
}

TEST(SupportHessian, IsPositiveSemidefiniteWithItsDirectionInTheNullSpace) {
  for (size_t i = 0; i < kCases; ++i) {
    RandomCase random(i);
    if (i % 3 == 0) random.direction[static_cast<int>(i / 3 % 3)] = 0.0;
    const auto& [p, half_axes, direction] = random;
    const Eigen::Matrix3d hessian = SupportHessian(half_axes, p, direction);
    const double scale = 1e-12 * (1.0 + hessian.norm());
    EXPECT_LT((hessian * direction).norm(), scale) << p;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(hessian);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -scale) << p;
  }
  EXPECT_TRUE(SupportHessian({0, 0, 1}, 2.0, {1, 0, 0}).isZero(0.0));  // no extent
}

TEST(SupportFunction, TheSupportPointReachesAsFarAsTheExtentInAnyDirection) {
  for (size_t i = 0; i < kCases; ++i) {
    const RandomCase random(i);
    for (const Eigen::Vector3d& direction : {random.direction, Eigen::Vector3d(0, 0, -2)}) {
      const SupportValue value = SupportFunction(random.half_axes, random.p, direction);
      EXPECT_NEAR(value.point.dot(direction), value.extent, 1e-12);
      EXPECT_NEAR(value.d_log_half_axes.sum(), value.extent, 1e-12);  // homogeneous in the size
      // No point of the body reaches farther.
      const Eigen::Vector3d other = RandomDirection();
      EXPECT_LE(SupportFunction(random.half_axes, random.p, other).point.dot(direction),
                value.extent + 1e-12);
    }
  }
}

TEST(SupportFunction, TouchesTheCuboidAtItsCorners) {
  for (size_t i = 0; i < kCases; ++i) {
    RandomCase random(i);
    random.direction = random.direction.array().sign() * (0.2 + random.direction.array().abs());
    const Eigen::Vector3d corner = random.direction.array().sign() * random.half_axes.array();
    EXPECT_LT((SupportFunction(random.half_axes, kCuboidExponent, random.direction).point - corner)
                  .norm(),
              0.002);
  }
}

TEST(SupportFunction, IsZeroForAFlatBodySeenFromItsSide) {
  const SupportValue value = SupportFunction({0, 1, 1}, kEllipsoidExponent, {1, 0, 0});
  EXPECT_EQ(value.extent, 0.0);
  EXPECT_TRUE(value.point.isZero());
}

}  // namespace
}  // namespace soslam
