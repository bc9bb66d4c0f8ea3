// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/kitti_object.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::Optional;

constexpr Box kUnit{0, 0, 10, 10};

Box Shifted(double x) { return {x, 0, 10 + x, 10}; }

TEST(MatchBoxes, TakesTheLargestOverlap) {
  EXPECT_THAT(MatchBoxes({{kUnit, 0.5}}, {Shifted(4), Shifted(1), Shifted(2)}, 0.1),
              ElementsAre(Optional(1)));
}

TEST(MatchBoxes, TheHighestScoreChoosesFirst) {
  EXPECT_THAT(MatchBoxes({{Shifted(2), 0.4}, {Shifted(1), 0.9}}, {kUnit, Shifted(6)}, 0.1),
              ElementsAre(Optional(1), Optional(0)));
}

TEST(MatchBoxes, IsOneToOneWithAMinimum) {
  EXPECT_THAT(MatchBoxes({{kUnit, 0.9}, {kUnit, 0.8}}, {kUnit}, 0.5),
              ElementsAre(Optional(0), std::nullopt));
  EXPECT_THAT(MatchBoxes({{Shifted(5), 0.9}}, {kUnit}, 0.34), ElementsAre(std::nullopt));
  EXPECT_THAT(MatchBoxes({{Shifted(5), 0.9}}, {kUnit}, 0.33), ElementsAre(Optional(0)));
  EXPECT_THAT(MatchBoxes({{kUnit, 0.9}}, {}, 0.5), ElementsAre(std::nullopt));
}

}  // namespace
}  // namespace soslam
