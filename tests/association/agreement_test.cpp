// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace soslam {
namespace {

using testing::ElementsAre;

// Frames with one detection each, of the given objects; labels "a", "b", ... by object.
Sequence GivenSequence(const std::vector<int>& objects) {
  Sequence sequence;
  sequence.planes.resize(1);
  const int count = *std::ranges::max_element(objects) + 1;
  for (int i = 0; i < count; ++i) {
    sequence.objects.push_back({10 * i, std::string(1, static_cast<char>('a' + i)), 0, {}});
    sequence.objects.back().ground_truth = GroundTruth{};
    sequence.objects.back().ground_truth->landmark_in_world.half_axes.x() = i + 1.0;
  }
  for (size_t i = 0; i < objects.size(); ++i) {
    sequence.frames.emplace_back();
    sequence.detections.emplace_back();
    sequence.detections.back().frame_index = static_cast<int>(i);
    sequence.detections.back().object_index = objects[i];
  }
  return sequence;
}

// One track per object found; -1: a detection of a track that is none.
Association Found(const std::vector<int>& objects) {
  Association association;
  const int count = *std::ranges::max_element(objects) + 1;
  association.tracks.resize(static_cast<size_t>(count) + 1);
  association.tracks.back().fate = TrackFate::kTooFewDetections;
  for (int i = 0; i < count; ++i) association.objects.push_back(i);
  for (size_t i = 0; i < objects.size(); ++i) {
    DetectionDecision decision;
    decision.object = objects[i];
    decision.track = objects[i] >= 0 ? objects[i] : count;
    Track& track = association.tracks[decision.track];
    track.detections.push_back(static_cast<int>(i));
    track.votes["x"] += 1.0;
    track.labels = {{"x", 1.0}};
    association.detections.push_back(decision);
  }
  return association;
}

TEST(CompareWithGivenTest, TheSamePartitionAgreesWhateverItsOrder) {
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 1, 1, 1}), Found({1, 1, 1, 0, 0, 0}), 3);
  EXPECT_EQ(agreement.Precision(), 1.0);
  EXPECT_EQ(agreement.Recall(), 1.0);
  EXPECT_EQ(agreement.F1(), 1.0);
  EXPECT_THAT(agreement.given_of_object, ElementsAre(1, 0));
}

TEST(CompareWithGivenTest, OfTwoHalvesOneMayMatch) {
  // Five of eight are more than half of all that either has, the other three are not.
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 0, 0, 0, 0, 0}), Found({0, 0, 0, 0, 0, 1, 1, 1}), 3);
  EXPECT_EQ(agreement.matched, 1);
  EXPECT_EQ(agreement.Precision(), 0.5);
  EXPECT_EQ(agreement.Recall(), 1.0);
  EXPECT_DOUBLE_EQ(agreement.F1().value(), 2.0 / 3.0);
  EXPECT_THAT(agreement.given_of_object, ElementsAre(0, std::nullopt));
}

TEST(CompareWithGivenTest, OfTwoInOneTheLargerMatchesEqualOnesDoNot) {
  const auto merged = [](const std::vector<int>& given) {
    const std::vector<int> found(given.size(), 0);
    return CompareWithGiven(GivenSequence(given), Found(found), 3);
  };
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1, 1}).matched, 1);
  EXPECT_THAT(merged({0, 0, 0, 1, 1, 1, 1}).given_of_object, ElementsAre(1));
  EXPECT_DOUBLE_EQ(merged({0, 0, 0, 1, 1, 1, 1}).F1().value(), 2.0 / 3.0);
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1}).matched, 0);
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1}).F1(), 0.0);
}

TEST(CompareWithGivenTest, GivenObjectsWithFewDetectionsDoNotCount) {
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 1, 1}), Found({0, 0, 0, -1, -1}), 3);
  EXPECT_EQ(agreement.given_objects, 1);
  EXPECT_EQ(agreement.F1(), 1.0);
}

TEST(CompareWithGivenTest, WithoutGivenObjectsThereIsNothingToCompareWith) {
  const Agreement agreement = CompareWithGiven(GivenSequence({0, 1, 2}), Found({0, 0, 0}), 3);
  EXPECT_FALSE(agreement.Precision());
  EXPECT_FALSE(agreement.Recall());
  EXPECT_FALSE(agreement.F1());
}

TEST(AssociatedSequenceTest, ObjectsAreTheFoundOnesWithTheGroundTruthOfTheGiven) {
  const Sequence given = GivenSequence({0, 0, 0, 1, 1, 1, 1});
  const Association found = Found({1, 1, 1, 0, 0, 0, -1});
  const Sequence associated = AssociatedSequence(given, found, CompareWithGiven(given, found, 3));
  ASSERT_EQ(associated.objects.size(), 2u);
  EXPECT_EQ(associated.objects[0].id, 1);
  EXPECT_EQ(associated.objects[0].label, "x");
  EXPECT_EQ(associated.objects[0].ground_truth->landmark_in_world.half_axes.x(), 2.0);
  EXPECT_EQ(associated.objects[1].ground_truth->landmark_in_world.half_axes.x(), 1.0);
  ASSERT_EQ(associated.detections.size(), 6u);
  EXPECT_EQ(associated.detections[0].object_index, 1);
  EXPECT_EQ(associated.detections[5].object_index, 0);
  EXPECT_EQ(associated.rejected_detections.at("too_few_detections"), 1);
  ASSERT_EQ(associated.rejected.size(), 1u);
  EXPECT_EQ(associated.rejected[0].stage, RejectingStage::kAssociate);
  EXPECT_EQ(associated.rejected[0].reason, "too_few_detections");
  EXPECT_EQ(associated.rejected[0].frame_index, given.detections[6].frame_index);
}

TEST(AssociatedSequenceTest, MovingObjectsAreNotCountedAndGiveNoGroundTruth) {
  Sequence given = GivenSequence({0, 0, 0, 1, 1, 1});
  given.objects[1].is_static = false;
  const Association found = Found({0, 0, 0, 1, 1, 1});
  const Agreement agreement = CompareWithGiven(given, found, 3);
  EXPECT_EQ(agreement.given_objects, 1);
  EXPECT_EQ(agreement.matched, 1);
  EXPECT_EQ(agreement.Precision(), 0.5);
  const Sequence associated = AssociatedSequence(given, found, agreement);
  EXPECT_TRUE(associated.objects[0].ground_truth);
  EXPECT_FALSE(associated.objects[1].ground_truth);
  EXPECT_TRUE(associated.objects[1].is_static);
}

}  // namespace
}  // namespace soslam
