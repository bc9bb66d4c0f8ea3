// SPDX-License-Identifier: BSD-3-Clause
// The quality of a map with every mistake that is counted.
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "support/map_quality_fixture.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::Pair;

class WallOfMistakesTest : public MapQualityTest {
 protected:
  void MakeAWallOfMistakes();
  void Shuffle();
};

// 15 true objects: 4 are found, each of the others is missed for a reason of its own; 14 landmarks.
void WallOfMistakesTest::MakeAWallOfMistakes() {
  const int seen_twice = AddTruth();
  Detect(seen_twice, AddLandmark(Truth(seen_twice)), 0, 3);
  Detect(seen_twice, AddLandmark(Shifted(seen_twice, {0, 9, 0})), 3, kFrames);  // split
  AddFound(kCube, "mouse");
  const int half = AddTruth();
  Detect(half, AddLandmark(Shifted(half, {0.2, 0, 0})));  // IoU 1/3
  const int elsewhere = AddTruth();
  Detect(elsewhere, AddLandmark(Shifted(elsewhere, {0.3, 0, 0})));  // 1/7
  const int large = AddTruth();
  Landmark twice = Shifted(large, {0, 0, 0.2});
  twice.half_axes *= 2.0;  // 1/8
  Detect(large, AddLandmark(twice));
  AddTruth();  // not detected
  Reject(AddTruth(), RejectingStage::kImport, "near_border");
  Reject(AddTruth(), RejectingStage::kAssociate, "too_few_detections");
  const int split = AddTruth();
  for (int i = 0; i < 3; ++i) Detect(split, AddObject(), 2 * i, 2 * i + 2);
  const int joined = AddTruth();
  const int joined_too = AddTruth();
  const int of_both = AddLandmark(Shifted(joined, {0, 9, 0}));
  Detect(joined, of_both, 0, 3);
  Detect(joined_too, of_both, 3, kFrames);
  const int not_estimated = AddObject();
  estimates_[not_estimated].failure = "too_few_views";
  Detect(AddTruth(), not_estimated);
  const int turned = AddTruth({0.3, 0.06, 0.2});
  Detect(turned, AddLandmark(RotatedAboutZ(Truth(turned), 44.0 * kRadPerDeg)));
  const int twice_found = AddFound();
  DetectNothing(AddLandmark(Shifted(twice_found, {0.1, 0, 0})));  // duplicate
  const int high = AddTruth();
  Detect(high, AddLandmark(Shifted(high, {0, 0, 0.3})));
  const Landmark nowhere = Shifted(high, {0, 20, 0});
  DetectNothing(AddLandmark(nowhere));                             // background
  DetectNothing(AddLandmark(Shifted(high, {1, 20, 0}), "mouse"));  // ignored label
  const Landmark measured_by_nobody = Shifted(high, {0, 0, 9});
  DetectNothing(AddLandmark(measured_by_nobody));
  sequence_.ignored = {{"mouse", std::nullopt}, {std::nullopt, measured_by_nobody}};
}

TEST_F(WallOfMistakesTest, AWallOfMistakesHasItsCountsAndReasons) {
  MakeAWallOfMistakes();
  const MapQuality quality = Evaluate();
  const MapScore& score = quality.scores[0];
  EXPECT_EQ(score.true_objects, 15);
  EXPECT_EQ(score.detectable, 14);
  EXPECT_EQ(score.landmarks, 14);
  EXPECT_EQ(score.ignored, 2);
  EXPECT_EQ(score.found, 4);
  EXPECT_EQ(score.found_detectable, 4);
  EXPECT_DOUBLE_EQ(score.precision.value(), 4.0 / 12.0);
  EXPECT_DOUBLE_EQ(score.recall.value(), 4.0 / 15.0);
  EXPECT_DOUBLE_EQ(score.f1.value(), 8.0 / 27.0);
  EXPECT_DOUBLE_EQ(score.recall_of_detectable.value(), 4.0 / 14.0);
  EXPECT_NEAR(score.of_found.iou_mean.value(), (3.0 + 1.0 / 3.0) / 4.0, 1e-9);
  EXPECT_EQ(score.of_found.labels_agree, 3);
  EXPECT_EQ(quality.scores[1].found, 3);
  EXPECT_THAT(quality.misses,
              ElementsAre(Pair(MapReason::kNotDetected, 1), Pair(MapReason::kGated, 1),
                          Pair(MapReason::kLostInAssociation, 1), Pair(MapReason::kSplit, 1),
                          Pair(MapReason::kJoined, 2), Pair(MapReason::kNoLandmark, 1),
                          Pair(MapReason::kWrongHeight, 1), Pair(MapReason::kWrongSize, 1),
                          Pair(MapReason::kWrongYaw, 1), Pair(MapReason::kWrongPlace, 1)));
  EXPECT_THAT(quality.false_landmarks,
              ElementsAre(Pair(MapReason::kSplit, 1), Pair(MapReason::kJoined, 1),
                          Pair(MapReason::kWrongHeight, 1), Pair(MapReason::kWrongSize, 1),
                          Pair(MapReason::kWrongYaw, 1), Pair(MapReason::kWrongPlace, 1),
                          Pair(MapReason::kDuplicate, 1), Pair(MapReason::kBackground, 1)));
  EXPECT_EQ(RowOf(quality, 6).miss->detail, "boxes in use in 0 frames; left out: 6 near_border");
  EXPECT_EQ(RowOf(quality, 11).miss->detail, "too_few_views");
}

// What does not depend on how the estimates lie in their world, nor on any order.
void ExpectSameSummary(const MapQuality& one, const MapQuality& other) {
  EXPECT_EQ(one.misses, other.misses);
  EXPECT_EQ(one.false_landmarks, other.false_landmarks);
  for (size_t i = 0; i < one.scores.size(); ++i) {
    const MapScore &a = one.scores[i], &b = other.scores[i];
    EXPECT_EQ(a.found, b.found);
    EXPECT_EQ(a.ignored, b.ignored);
    EXPECT_EQ(a.detectable, b.detectable);
    EXPECT_NEAR(a.of_found.iou_mean.value(), b.of_found.iou_mean.value(), 1e-9);
    EXPECT_NEAR(a.of_found.centre_m_mean.value(), b.of_found.centre_m_mean.value(), 1e-9);
    EXPECT_NEAR(a.of_found.log_scale_mean.value(), b.of_found.log_scale_mean.value(), 1e-9);
    EXPECT_NEAR(a.of_found.up_error_deg_mean.value(), b.of_found.up_error_deg_mean.value(), 1e-5);
    EXPECT_NEAR(a.of_found.yaw_error_deg_mean.value(), b.of_found.yaw_error_deg_mean.value(), 1e-5);
    EXPECT_NEAR(a.precision.value(), b.precision.value(), 1e-12);
    EXPECT_NEAR(a.f1_of_detectable.value(), b.f1_of_detectable.value(), 1e-12);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(a.of_found.log_size_mean[axis].value(), b.of_found.log_size_mean[axis].value(),
                  1e-9);
    }
  }
  EXPECT_NEAR(one.in_frames.iou_mean.value(), other.in_frames.iou_mean.value(), 1e-9);
}

// The same, landmark by landmark.
void ExpectSameFigures(const MapQuality& one, const MapQuality& other) {
  ExpectSameSummary(one, other);
  ASSERT_EQ(one.landmarks.size(), other.landmarks.size());
  for (size_t i = 0; i < one.landmarks.size(); ++i) {
    const LandmarkRow &a = one.landmarks[i], &b = other.landmarks[i];
    EXPECT_EQ(a.true_index, b.true_index);
    if (!a.errors) continue;
    EXPECT_NEAR(a.errors->iou, b.errors->iou, 1e-9);
    EXPECT_NEAR(a.errors->centre_m, b.errors->centre_m, 1e-9);
    EXPECT_NEAR(a.plane->offset_m, b.plane->offset_m, 1e-9);
    EXPECT_NEAR(a.plane->tilt_deg, b.plane->tilt_deg, 1e-5);
  }
}

TEST_F(WallOfMistakesTest, MotionAndScaleOfAWholeMapChangeNothing) {
  MakeAWallOfMistakes();
  const MapQuality at_home = Evaluate(AlignmentKind::kNone);
  ExpectSameFigures(at_home, Evaluate(AlignmentKind::kRigid));
  for (const double scale : {1.0, 0.2, 7.0}) {
    const Alignment away{AlignmentKind::kSimilarity, CameraPath::kGeneral, scale, RandomRigid(),
                         kFrames};
    const auto sequence = sequence_;
    const auto estimates = estimates_;
    Move(away);
    const MapQuality similar = Evaluate(AlignmentKind::kSimilarity);
    ExpectSameFigures(at_home, similar);
    EXPECT_NEAR(similar.alignments.of_segment.at(0).scale, 1.0 / scale, 1e-9);
    if (scale == 1.0) ExpectSameFigures(at_home, Evaluate(AlignmentKind::kRigid));
    sequence_ = sequence;
    estimates_ = estimates;
  }
}

// Objects, true objects, detections and estimates in another order, with other ids.
void WallOfMistakesTest::Shuffle() {
  const std::vector<Object> old = sequence_.objects;
  std::ranges::shuffle(sequence_.objects, TestRandom());
  std::ranges::shuffle(sequence_.true_objects, TestRandom());
  const auto index_of = [](const auto& objects, int id) {
    const auto id_of = [](const auto& object) { return object.id; };
    return static_cast<int>(std::ranges::find(objects, id, id_of) - objects.begin());
  };
  const auto move = [&](int* index) { *index = index_of(sequence_.objects, old[*index].id); };
  for (ObjectEstimate& estimate : estimates_) move(&estimate.object_index);
  for (Detection& detection : sequence_.detections) {
    move(&detection.object_index);
    std::optional<int>& true_id = detection.true_object_id;
    if (true_id) true_id = index_of(sequence_.true_objects, *true_id);
  }
  // Boxes have the indices of true objects for ids now.
  const auto renumber = [](auto* objects, int first) {
    for (auto& object : *objects) object.id = first++;
  };
  renumber(&sequence_.true_objects, 0);
  renumber(&sequence_.objects, 500);
  std::ranges::shuffle(sequence_.detections, TestRandom());
  std::ranges::shuffle(sequence_.rejected, TestRandom());
  std::ranges::shuffle(estimates_, TestRandom());
  std::ranges::reverse(sequence_.ignored);
}

TEST_F(WallOfMistakesTest, OrderDoesNotMatter) {
  MakeAWallOfMistakes();
  const MapQuality before = Evaluate();
  for (int trial = 0; trial < 10; ++trial) {
    Shuffle();
    ExpectSameSummary(before, Evaluate());
  }
}

TEST_F(WallOfMistakesTest, NamesDoNotMatter) {
  MakeAWallOfMistakes();
  const MapQuality before = Evaluate();
  for (Object& object : sequence_.objects) {
    if (object.label != "mouse") object.label = "thing";
  }
  for (TrueObject& object : sequence_.true_objects) object.label = "other";
  for (Detection& detection : sequence_.detections) detection.true_object_id.reset();
  const MapQuality after = Evaluate();
  ExpectSameFigures(before, after);
  EXPECT_EQ(after.scores[0].of_found.labels_agree, 0);
  EXPECT_EQ(before.scores[0].of_found.ids_agree, 4);
  EXPECT_EQ(after.scores[0].of_found.ids_known, 0);
}

}  // namespace
}  // namespace soslam
