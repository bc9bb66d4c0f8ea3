// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/box.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

TEST(BoxOverlap, IsIntersectionOverUnion) {
  constexpr Box kBox{0, 0, 10, 10};
  EXPECT_EQ(BoxOverlap(kBox, kBox), 1.0);
  EXPECT_DOUBLE_EQ(BoxOverlap(kBox, {5, 0, 15, 10}), 50.0 / 150.0);
  EXPECT_DOUBLE_EQ(BoxOverlap(kBox, {2, 2, 4, 4}), 0.04);
  EXPECT_EQ(BoxOverlap(kBox, {10, 0, 20, 10}), 0.0);
  EXPECT_EQ(BoxOverlap(kBox, {3, 3, 3, 3}), 0.0);
}

}  // namespace
}  // namespace soslam
