// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/support_of_four.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

// Compares with SupportFunction, whose derivatives are checked numerically elsewhere.
TEST(SupportOfFour, IsTheSupportFunctionOfEach) {
  for (const double p : kShapeExponents) {
    const Eigen::Vector3d half_axes = RandomVector(0.1, 0.8);
    std::array<Eigen::Vector3d, 4> directions;
    alignas(kFourAlignment) ThreeFours m;
    for (size_t k = 0; k < 4; ++k) {
      directions[k] = RandomVector(-1.0, 1.0);
      for (size_t i = 0; i < 3; ++i) m[i][k] = directions[k][static_cast<int>(i)];
    }
    SupportOfFour support;
    FindSupport(half_axes, p, m, &support);
    const ThreeFours contact = support.Contact(p, m);
    for (size_t k = 0; k < 4; ++k) {
      const SupportValue expected = SupportFunction(half_axes, p, directions[k]);
      EXPECT_NEAR(support.extent[k], expected.extent, 1e-12);
      for (size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<int>(i);
        EXPECT_NEAR(contact[i][k], expected.contact[axis], 1e-12);
        EXPECT_NEAR(support.by_log_half_axes[i][k], expected.by_log_half_axes[axis], 1e-12);
      }
    }
  }
}

TEST(SupportOfFour, OfABodyWithoutSizeIsZero) {
  for (const double p : kShapeExponents) {
    alignas(kFourAlignment) ThreeFours m{};
    for (size_t k = 0; k < 4; ++k) m[2][k] = RandomUniform(0.5, 1.0);
    const Eigen::Vector3d half_axes = Eigen::Vector3d::Zero();
    SupportOfFour support;
    FindSupport(half_axes, p, m, &support);
    const ThreeFours contact = support.Contact(p, m);
    for (size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(support.extent[k], SupportFunction(half_axes, p, {0.0, 0.0, m[2][k]}).extent);
      EXPECT_EQ(support.inverse[k], 0.0);
      EXPECT_EQ(support.shares[2][k], 0.0);
      EXPECT_EQ(contact[2][k], 0.0);
    }
  }
}

}  // namespace
}  // namespace soslam
