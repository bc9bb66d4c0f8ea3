// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/text.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

TEST(LikelyMeant, IsTheNearestName) {
  const std::vector<std::string> known = {"chair", "stair", "monitor", "tv", "bus"};
  EXPECT_EQ(LikelyMeant("chiar", known), "chair");
  EXPECT_EQ(LikelyMeant("stairs", known), "stair");
  EXPECT_EQ(LikelyMeant("shair", known), "chair");  // as near as the second
  EXPECT_EQ(LikelyMeant("tvmonitor", known), "monitor");
  EXPECT_EQ(LikelyMeant("chai", known), "chair");
}

TEST(LikelyMeant, IsNoneForOtherWords) {
  const std::vector<std::string> known = {"chair", "monitor", "tv", "bus"};
  for (const char* word : {"", "sofa", "box", "t", "mon", "charmed"}) {
    EXPECT_EQ(LikelyMeant(word, known), std::nullopt) << word;
  }
  EXPECT_EQ(LikelyMeant(std::string(65, 'a'), {std::string(65, 'a')}), std::nullopt);
}

}  // namespace
}  // namespace soslam
