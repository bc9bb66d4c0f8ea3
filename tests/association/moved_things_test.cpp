// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/moved_things.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/association_scenes.h"

namespace soslam {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// Two equal things and another one on a floor, all in view of a camera that moves sideways.
class MovedThingsTest : public testing::Test {
 protected:
  MovedThingsTest() {
    scene_.name = "moved";
    scene_.camera = {640, 480, 500.0, 500.0, 319.5, 239.5};
    scene_.planes.push_back({3, "floor", Plane{}, std::nullopt});
    scene_.objects.push_back({1, "thing", Shape::kBox, {0.2, 0.2, 0.2}, {3.0, -0.7}, 0.4, 0, 1});
    scene_.objects.push_back({2, "thing", Shape::kBox, {0.2, 0.2, 0.2}, {3.2, 0.7}, 0.2, 0, 1});
    scene_.objects.push_back({3, "other", Shape::kBox, {0.2, 0.2, 0.2}, {3.8, 0.1}, 0.0, 0, 3});
    scene_.trajectory.frames = 40;
    scene_.trajectory.waypoints = {{{0.0, -0.4, 0.8}, {3.5, 0.0, 0.3}},
                                   {{0.0, 0.4, 0.8}, {3.5, 0.0, 0.3}}};
    scene_.noise.box_sigma_px = 0.5;
    scene_.seed = 5;
  }

  Association Associated() {
    sequence_ = WithoutIds(SyntheticSequence(scene_, true));
    return Associate(sequence_, UnknowingTable(), PairEvidence(), EstimatedAssociation(), 2);
  }
  // The thing stands at the place of the first object before this frame, then at the second one's.
  void Move(int frame) {
    scene_.objects[0].until_frame = frame;
    scene_.objects[1].from_frame = frame;
  }

  Scene scene_;
  Sequence sequence_;
};

TEST_F(MovedThingsTest, AThingThatIsMovedIsSaid) {
  Move(20);
  const Association association = Associated();
  ASSERT_THAT(association.objects, SizeIs(3));
  ASSERT_THAT(association.moved_things, SizeIs(1));
  const MovedThing& moved = association.moved_things.front();
  EXPECT_EQ(moved.frames_left, 20);
  EXPECT_EQ(moved.frames_not_yet, 20);
  EXPECT_GT(moved.probability, 0.9);
  const auto findings = CheckMovedThings(sequence_, association);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings.front().found,
              HasSubstr(fmt::format("thing (object {}, in frames 0 to 19) and thing (object {}, in "
                                    "frames 20 to 39)",
                                    moved.object + 1, moved.later_object + 1)));
}

TEST_F(MovedThingsTest, FewerImagesSayLess) {
  Move(20);
  const double of_many = Associated().moved_things.at(0).probability;
  Move(37);  // three images of the second place
  const double of_three = Associated().moved_things.at(0).probability;
  EXPECT_LT(of_three, of_many);
  scene_.trajectory.frames = 6;
  Move(3);
  EXPECT_LT(Associated().moved_things.at(0).probability, of_three);
}

TEST_F(MovedThingsTest, TwoEqualThingsThatStandStillAreNot) {
  scene_.noise.miss_probability = 0.3;
  for (scene_.seed = 0; scene_.seed < 5; ++scene_.seed) {
    const Association association = Associated();
    EXPECT_THAT(association.moved_things, IsEmpty()) << scene_.seed;
    EXPECT_THAT(CheckMovedThings(sequence_, association), IsEmpty());
  }
}

// The camera turns from the one to the other, and does not see that the places are empty.
TEST_F(MovedThingsTest, PlacesThatAreNotSeenEmptyTellNothing) {
  Move(20);
  scene_.objects[0].position_on_plane = {3.0, -2.5};
  scene_.objects[1].position_on_plane = {3.0, 2.5};
  scene_.trajectory.waypoints = {{{0.0, 0.0, 0.8}, {3.0, -2.5, 0.3}},
                                 {{0.0, 0.0, 0.8}, {3.0, 2.5, 0.3}}};
  EXPECT_THAT(Associated().moved_things, IsEmpty());
}

TEST_F(MovedThingsTest, ThingsOfOtherLabelsAreOthers) {
  Move(20);
  scene_.objects[1].label = "third";
  EXPECT_THAT(Associated().moved_things, IsEmpty());
}

// A box of low score is at the first place all the time: the thing is still there.
TEST_F(MovedThingsTest, APlaceWithAnotherBoxIsNotEmpty) {
  Move(20);
  Associated();
  Scene still = scene_;
  still.objects[0].until_frame.reset();
  for (const SimulatedBox& row : Simulate(still, false).detections) {
    if (row.object_index != 0 || row.frame_index < 20) continue;
    sequence_.rejected.push_back(
        {row.frame_index, "vase", 0.1, row.box, {}, RejectingStage::kImport, "low_score"});
  }
  EXPECT_THAT(Associate(sequence_, UnknowingTable(), PairEvidence(), EstimatedAssociation(), 2)
                  .moved_things,
              IsEmpty());
}

}  // namespace
}  // namespace soslam
