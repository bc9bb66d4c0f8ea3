// SPDX-License-Identifier: BSD-3-Clause
#include "base/exponential_of_four.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace soslam {
namespace {

struct alignas(kFourAlignment) Exponentials {
  std::array<Four, 1> x, found;
};

SOSLAM_MULTIVERSION void Find(Exponentials* exponentials) {
  Exponential(exponentials->x, &exponentials->found);
}

double Found(double x) {
  Exponentials exponentials{};
  exponentials.x[0][2] = x;
  Find(&exponentials);
  EXPECT_EQ(exponentials.found[0][1], 1.0);  // that of 0
  return exponentials.found[0][2];
}

TEST(ExponentialOfFour, IsThatOfTheStandardLibrary) {
  for (double x = -700.0; x < 700.0; x += 0.37) EXPECT_NEAR(Found(x) / std::exp(x), 1.0, 1e-14);
}

TEST(ExponentialOfFour, IsThatOfTheLeastOrTheMostBeyondThem) {
  EXPECT_NEAR(Found(-708.0) / std::exp(-708.0), 1.0, 1e-14);
  EXPECT_NEAR(Found(709.0) / std::exp(709.0), 1.0, 1e-14);
  EXPECT_EQ(Found(-1e9), Found(-708.0));
  EXPECT_EQ(Found(std::nan("")), Found(-708.0));
  EXPECT_EQ(Found(1e9), Found(709.0));
}

TEST(ExponentialOfFour, StaysNormal) {
  EXPECT_TRUE(std::isnormal(Found(-1e9)));
  EXPECT_LT(Found(-1e9), 1e-307);
  EXPECT_TRUE(std::isnormal(Found(1e9)));
  EXPECT_GT(Found(1e9), 1e307);
}

}  // namespace
}  // namespace soslam
