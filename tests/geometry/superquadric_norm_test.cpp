// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "soslam/geometry/support_function.h"
#include "support/numeric_derivatives.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr int kCases = 200;

// Exponents of support functions and of surfaces, from 1 to infinity.
std::vector<ShapeExponents> AllExponents() {
  std::vector<ShapeExponents> all(kShapeExponents.begin(), kShapeExponents.end());
  for (const ShapeExponents& p : kShapeExponents) all.push_back(DualExponents(p));
  return all;
}

double Norm(const Eigen::Array3d& u, const ShapeExponents& p) {
  return SuperquadricNorm(u, p).value;
}

TEST(SuperquadricNorm, OfOneExponentIsThePNorm) {
  for (int i = 0; i < kCases; ++i) {
    const Eigen::Array3d u = RandomVector(-1.0, 1.0);
    const double p = RandomUniform(1.0, 12.0);
    EXPECT_NEAR(Norm(u, p), std::pow(u.abs().pow(p).sum(), 1.0 / p), 1e-12);
    EXPECT_NEAR(Norm(u, DualExponents(kCuboidExponent)), u.abs().maxCoeff(), 1e-12);
  }
}

// Hoelder's inequality: u . v is at most the product of the norms of dual exponents, and reaches it
// for some v.
TEST(SuperquadricNorm, IsDualToThatOfTheDualExponents) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < kCases; ++i) {
      const Eigen::Array3d u = RandomVector(-1.0, 1.0), v = RandomVector(-1.0, 1.0);
      EXPECT_LE((u * v).sum(), Norm(u, p) * Norm(v, DualExponents(p)) + 1e-12) << p;
      const auto [value, slopes] = SuperquadricNorm(u, p);
      EXPECT_NEAR(Norm(slopes, DualExponents(p)), 1.0, 1e-9) << p;
      EXPECT_NEAR((u * slopes).sum(), value, 1e-12) << p;
    }
  }
}

TEST(SuperquadricNorm, DerivativesAgreeWithNumbers) {
  for (const ShapeExponents& p : AllExponents()) {
    for (int i = 0; i < kCases; ++i) {
      Eigen::Array3d u = RandomVector(-1.0, 1.0);
      u = u.sign() * (0.1 + u.abs());  // off the kinks
      Eigen::Matrix3d hessian;
      const Eigen::Vector3d slopes = SuperquadricNorm(u, p, &hessian).slopes;
      const auto norm = [&](const Eigen::Vector3d& at) { return Norm(at, p); };
      const auto slopes_at = [&](const Eigen::Vector3d& at) -> Eigen::Vector3d {
        return SuperquadricNorm(at, p).slopes;
      };
      EXPECT_LT((slopes - NumericDerivatives(norm, u)).cwiseAbs().maxCoeff(), 1e-7) << p;
      const Eigen::Matrix3d error = hessian - NumericDerivatives(slopes_at, u);
      EXPECT_LT(error.colwise().norm().maxCoeff(), 1e-5 * (1.0 + hessian.norm())) << p;
    }
  }
}

// Where a component is zero; with exponents from 2 the norm has no kink there.
TEST(SuperquadricNorm, HessianAgreesWithNumbersAtZero) {
  for (const ShapeExponents& p : {ShapeExponents(2.0, 1.5), ShapeExponents(3.0, 2.0)}) {
    const Eigen::Vector3d u(0.5, 0.0, 0.3);
    Eigen::Matrix3d hessian;
    SuperquadricNorm(u, p, &hessian);
    const auto slopes_at = [&](const Eigen::Vector3d& at) -> Eigen::Vector3d {
      return SuperquadricNorm(at, p).slopes;
    };
    const Eigen::Matrix3d error = hessian - NumericDerivatives(slopes_at, u);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-5) << p;
  }
}
}  // namespace
}  // namespace soslam
