// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/reasons.h"

#include <gmock/gmock.h>

namespace soslam {
namespace {

TEST(ReasonsTest, HaveWordsAndARemedyWhereTheDataAreWrong) {
  EXPECT_EQ(ReasonOf("near_border").words, "too near the image border");
  EXPECT_THAT(ReasonOf("near_border").remedy, testing::HasSubstr("border_px"));
  EXPECT_EQ(ReasonOf("moves").words, "of a kind that moves");
  EXPECT_EQ(ReasonOf("moves").remedy, "");
}

TEST(ReasonsTest, CodesThatSayEnoughHaveBlanks) {
  EXPECT_EQ(ReasonOf("too_few_visible_pairs").words, "too few visible pairs");
  EXPECT_EQ(ReasonOf("").words, "");
}

TEST(ReasonsTest, CodesOfTheSameWordsAreCountedTogether) {
  EXPECT_THAT(ReasonsInWords({{"no_finite_quadric", 2}, {"no_solution", 3}, {"low_box", 1}}),
              testing::ElementsAre(testing::Pair("low box", 1),
                                   testing::Pair("without a body that fits its boxes", 5)));
}

}  // namespace
}  // namespace soslam
