// SPDX-License-Identifier: BSD-3-Clause
#include "base/wide_loops.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace soslam {
namespace {

struct alignas(kFourAlignment) Fours {
  std::array<Four, 4> numbers;
  Four sums;
};

void SumInAnyRegisters(Fours* fours) { SumEach(fours->numbers.data(), &fours->sums); }
SOSLAM_FOR_AVX2 void SumInWideRegisters(Fours* fours) {
  SumEach(fours->numbers.data(), &fours->sums);
}

class SumEachTest : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !HasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  }
  static void Sum(Fours* fours) { (GetParam() ? SumInWideRegisters : SumInAnyRegisters)(fours); }
};

// Each number has a bit of its own.
TEST_P(SumEachTest, EachSumIsThatOfItsOwnFour) {
  Fours fours{};
  for (int i = 0; i < 16; ++i) fours.numbers[i / 4][i % 4] = std::ldexp(1.0, i);
  Sum(&fours);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(fours.sums[i], std::ldexp(15.0, 4 * i)) << i;
}

// One after the other, or every second one, the ones are lost in what is large.
TEST_P(SumEachTest, AddsPairsOfNeighbours) {
  Fours fours{};
  for (Four& numbers : fours.numbers) numbers = Four{1.0, 1.0, 1e17, -1e17};
  Sum(&fours);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(fours.sums[i], 2.0) << i;
    EXPECT_EQ(soslam::Sum(fours.numbers[i]), 2.0) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(InRegisters, SumEachTest, testing::Bool(),
                         [](const auto& wide) { return wide.param ? "Wide" : "OfAnyWidth"; });

// 2^24 + 1 is no number of single precision.
TEST(SumOfEight, IsInDoublePrecision) {
  EXPECT_EQ(Sum(Eight{0.0F, 0.0F, 0.0F, 16777216.0F, 0.0F, 0.0F, 0.0F, 1.0F}), 16777217.0);
}

}  // namespace
}  // namespace soslam
