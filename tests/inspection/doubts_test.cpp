// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(DistrustOfMapTest, IsOfUpAndScaleTogetherOrOfPhotosWithoutAPlace) {
  Sequence sequence;
  sequence.frames.resize(5);
  EXPECT_EQ(DistrustOfMap(nullptr, sequence), "");
  WorldReport world;
  world.up.probability = 0.8;
  world.scale.emplace().probability = 0.7;
  EXPECT_EQ(DistrustOfMap(&world, sequence), "");
  world.scale->probability = 0.6;
  EXPECT_THAT(DistrustOfMap(&world, sequence), AllOf(HasSubstr("80 %"), HasSubstr("60 %")));
  world.scale.reset();  // proportions are right nevertheless
  EXPECT_EQ(DistrustOfMap(&world, sequence), "");
  sequence.images_without_pose.resize(5, "a.png");
  EXPECT_EQ(DistrustOfMap(&world, sequence), "");
  sequence.images_without_pose.resize(6, "a.png");
  EXPECT_EQ(DistrustOfMap(&world, sequence), "5 of 11 photos have a place");
}

}  // namespace
}  // namespace soslam
