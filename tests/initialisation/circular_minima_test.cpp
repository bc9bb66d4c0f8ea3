// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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
