// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/support_function.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/numeric_derivatives.h"
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

  // With a direction off the rounded kinks, where second derivatives are up to 1 / kEdgeRounding.
  RandomCase OffKinks(double distance) const {
    RandomCase off = *this;
    off.direction = direction.array().sign() * (distance + direction.array().abs());
    return off;
  }
};

constexpr size_t kRandomCases = 300;

double Extent(const Eigen::Vector3d& half_axes, const ShapeExponents& p,
              const Eigen::Vector3d& direction) {
  return SupportFunction(half_axes, p, direction).extent;
}

TEST(SupportFunction, DerivativesAgreeWithNumbers) {
  for (size_t i = 0; i < kRandomCases; ++i) {
    const RandomCase off = RandomCase(i).OffKinks(0.1);
    const ShapeExponents& p = off.p;
    const Eigen::Vector3d &half_axes = off.half_axes, &direction = off.direction;
    const SupportValue value = SupportFunction(half_axes, p, direction);
    const auto towards = [&](const Eigen::Vector3d& at) { return Extent(half_axes, p, at); };
    const auto of_log_half_axes = [&](const Eigen::Vector3d& at) {
      return Extent(at.array().exp(), p, direction);
    };
    const Eigen::Vector3d point = NumericDerivatives(towards, direction);
    const Eigen::Vector3d slopes = NumericDerivatives(of_log_half_axes, half_axes.array().log());
    EXPECT_LT((value.point - point).cwiseAbs().maxCoeff(), 1e-8) << p;
    EXPECT_LT((value.d_log_half_axes - slopes).cwiseAbs().maxCoeff(), 1e-8) << p;
  }
}

TEST(SupportHessian, IsTheDerivativeOfTheSupportPoint) {
  for (size_t i = 0; i < kRandomCases; ++i) {
    const RandomCase off = RandomCase(i).OffKinks(0.1);
    const ShapeExponents& p = off.p;
    const Eigen::Vector3d &half_axes = off.half_axes, &direction = off.direction;
    const auto point_towards = [&](const Eigen::Vector3d& at) {
      return SupportFunction(half_axes, p, at).point;
    };
    const Eigen::Matrix3d numeric = NumericDerivatives(point_towards, direction);
    const Eigen::Matrix3d error = SupportHessian(half_axes, p, direction) - numeric;
    EXPECT_LT(error.colwise().norm().maxCoeff(), 1e-7) << p;
  }
}

TEST(SupportHessian, IsPositiveSemidefiniteWithItsDirectionInTheNullSpace) {
  for (size_t i = 0; i < kRandomCases; ++i) {
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
  for (size_t i = 0; i < kRandomCases; ++i) {
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
  for (size_t i = 0; i < kRandomCases; ++i) {
    const auto [p, half_axes, direction] = RandomCase(i).OffKinks(0.2);
    const Eigen::Vector3d corner = direction.array().sign() * half_axes.array();
    const SupportValue value = SupportFunction(half_axes, kCuboidExponent, direction);
    EXPECT_LT((value.point - corner).norm(), 0.002);
  }
}

}  // namespace
}  // namespace soslam
