// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "constraints/tangency.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(WithoutBias, MovesEdgesByFractionsOfTheBox) {
  const Box box{100, 200, 300, 600};
  EXPECT_EQ(WithoutBias(box, {}, {0.25, -0.5, 0.0, 0.125}), (Box{150, 0, 300, 550}));
  EXPECT_EQ(WithoutBias(box, {}, {}), box);
}

TEST(WithoutBias, LeavesOneSidedEdgesWhereTheyAre) {
  const Box box{100, 200, 300, 600};
  EXPECT_EQ(WithoutBias(box, {true, false, true, true}, {0.25, 0.25, 0.25, 0.25}),
            (Box{100, 300, 300, 600}));
}

TEST(BoxEdges, AreThoseOfTheBoxWithoutBias) {
  const Box box{100, 200, 300, 400};
  const std::array<bool, 4> is_one_sided = {false, false, true, false};
  const EdgeBias bias = {0.1, -0.05, 0.3, -0.2};
  const auto biased = BoxEdges(TestCamera(), box, is_one_sided, 0.02, bias);
  const auto corrected =
      BoxEdges(TestCamera(), WithoutBias(box, is_one_sided, bias), is_one_sided, 0.02);
  for (size_t i = 0; i < biased.size(); ++i) {
    EXPECT_EQ(biased[i].plane, corrected[i].plane);
    EXPECT_EQ(biased[i].is_one_sided, is_one_sided[i]);
    EXPECT_DOUBLE_EQ(biased[i].sigma_px, 4.0);  // of the detected box
  }
}

}  // namespace
}  // namespace soslam
