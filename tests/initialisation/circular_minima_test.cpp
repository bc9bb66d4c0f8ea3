// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "initialisation/yaw_sweep.h"
#include "support/random.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(CircularMinima, OfAWaveAreItsTroughsLowestFirst) {
  for (int i = 0; i < 50; ++i) {
    // Troughs at quarter, three quarters, ... of a period, lowered by their index.
    const int troughs = 2 + i % 4;
    const double phase = RandomUniform(0.0, 1.0);
    constexpr int kPoints = 240;
    std::vector<double> values;
    for (int k = 0; k < kPoints; ++k) {
      const double turn = (k + phase) / kPoints;
      values.push_back(-std::cos(2.0 * std::numbers::pi * troughs * turn) +
                       0.1 * std::sin(2.0 * std::numbers::pi * turn));
    }
    const auto minima = CircularMinima(values);
    ASSERT_EQ(minima.size(), static_cast<size_t>(troughs));
    EXPECT_EQ(values[minima.front()], *std::min_element(values.begin(), values.end()));
    for (size_t k = 1; k < minima.size(); ++k) {
      EXPECT_LE(values[minima[k - 1]], values[minima[k]]);
    }
  }
}

TEST(CircularMinima, GoRoundTheEnds) {
  EXPECT_THAT(CircularMinima({0, 1, 2, 1}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({1, 2, 1, 0}), ElementsAre(3));
  EXPECT_THAT(CircularMinima({1, 0, 1, 2, 3, 2}), ElementsAre(1));
  EXPECT_THAT(CircularMinima({2, 5, 1, 5}), ElementsAre(2, 0));
}

TEST(CircularMinima, OfPlateausAreTheirFirstIndices) {
  EXPECT_THAT(CircularMinima({3, 1, 1, 1, 3, 2}), ElementsAre(1, 5));
  EXPECT_THAT(CircularMinima({1, 1, 2, 3, 1}), ElementsAre(4));  // goes round the end
  EXPECT_THAT(CircularMinima({1, 2, 3, 1, 1}), ElementsAre(3));
  EXPECT_THAT(CircularMinima({1, 2, 2, 3, 2, 2}), ElementsAre(0));  // steps on the way are none
  EXPECT_THAT(CircularMinima({1, 1, 5, 1, 5}), ElementsAre(0, 3));  // equal ones in their order
}

TEST(CircularMinima, OfAConstantIsTheFirstIndex) {
  EXPECT_THAT(CircularMinima({4}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({4, 4, 4, 4}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({}), IsEmpty());
}

TEST(CircularMinima, CountNaNAsHigh) {
  EXPECT_THAT(CircularMinima({kNaN, kNaN}), IsEmpty());
  EXPECT_THAT(CircularMinima({kNaN, 2, kNaN, 1, 3}), ElementsAre(3, 1));
  EXPECT_THAT(CircularMinima({2, 2, kNaN}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({2, kNaN, 2}), ElementsAre(2));
  EXPECT_THAT(CircularMinima({kNaN, 3, 2, kNaN, 2, 1}), ElementsAre(5, 2));
}

}  // namespace
}  // namespace soslam
