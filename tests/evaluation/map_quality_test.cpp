// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "evaluation/map_reasons.h"
#include "geometry/angles.h"
#include "support/random.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr int kFrames = 6;
const Eigen::Vector3d kCube = Eigen::Vector3d::Constant(0.2);

// A wall of true objects, 7 in a row, 0.4 m wide and 0.4 m apart, 5 m in front of a camera that
// goes by, and a map of what the test says was made of them.
class MapQualityTest : public testing::Test {
 protected:
  MapQualityTest() {
    sequence_.camera = TestCamera();
    const Eigen::Quaterniond world_from_camera(
        (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished());
    for (int i = 0; i < kFrames; ++i) {
      Frame frame;
      frame.id = i;
      frame.world_from_camera = {world_from_camera,
                                 {0.1 * i - 0.25, 0.02 * i * i, 1.5 + 0.03 * std::sin(2.0 * i)}};
      frame.true_world_from_camera = frame.world_from_camera;
      sequence_.frames.push_back(frame);
    }
    sequence_.planes.push_back({0, {Eigen::Vector3d::UnitZ(), 0.0}});
  }

  int AddTruth(const Eigen::Vector3d& half_axes = kCube) {
    const auto index = static_cast<int>(sequence_.true_objects.size());
    TrueObject object;
    object.id = 10 + index;
    object.label = "box";
    object.truth.landmark_in_world.half_axes = half_axes;
    object.truth.landmark_in_world.frame_from_object.translation = {
        0.8 * (index % 7) - 2.4, 5.0, 1.1 * (index / 7) + half_axes.z()};
    sequence_.true_objects.push_back(object);
    return index;
  }
  Landmark Truth(int index) const {
    return sequence_.true_objects[static_cast<size_t>(index)].truth.landmark_in_world;
  }
  Landmark Shifted(int index, const Eigen::Vector3d& shift) const {
    Landmark landmark = Truth(index);
    landmark.frame_from_object.translation += shift;
    return landmark;
  }

  int AddObject(const std::string& label = "box") {
    const auto index = static_cast<int>(sequence_.objects.size());
    Object object;
    object.id = 100 + index;
    object.label = label;
    sequence_.objects.push_back(object);
    estimates_.push_back({index, 0, std::nullopt, std::nullopt, ""});
    return index;
  }
  int AddLandmark(const Landmark& landmark, const std::string& label = "box") {
    const int object = AddObject(label);
    estimates_[static_cast<size_t>(object)].landmark_in_world = landmark;
    return object;
  }

  // The box of a body in a frame.
  Box BoxOf(const Landmark& landmark, int frame) const {
    Landmark in_camera = Transform(
        sequence_.frames[static_cast<size_t>(frame)].true_world_from_camera->Inverse(), landmark);
    in_camera.shape_exponent = kCuboidExponent;
    return OutlineBox(sequence_.camera, in_camera).value();
  }
  // Boxes of a true object become those of an object, in frames from first to before last.
  void Detect(int truth, int object, int first = 0, int last = kFrames) {
    for (int frame = first; frame < last; ++frame) {
      Detection detection;
      detection.frame_index = frame;
      detection.object_index = object;
      detection.box = BoxOf(Truth(truth), frame);
      detection.true_object_id = sequence_.true_objects[static_cast<size_t>(truth)].id;
      sequence_.detections.push_back(detection);
    }
  }
  void DetectNothing(int object) {
    for (int frame = 0; frame < kFrames; ++frame) {
      Detection detection;
      detection.frame_index = frame;
      detection.object_index = object;
      detection.box = {10.0, 10.0, 40.0, 30.0 + object};
      sequence_.detections.push_back(detection);
    }
  }
  void Reject(int truth, RejectingStage stage, const std::string& reason) {
    for (int frame = 0; frame < kFrames; ++frame) {
      sequence_.rejected.push_back(
          {frame, "box", 0.5, BoxOf(Truth(truth), frame), std::nullopt, stage, reason});
    }
  }
  void SayInFrames(int truth, const Landmark& landmark) {
    for (int frame = 0; frame < kFrames; ++frame) {
      sequence_.truth_in_frames.push_back(
          {frame, sequence_.true_objects[static_cast<size_t>(truth)].id,
           Transform(sequence_.frames[static_cast<size_t>(frame)].world_from_camera.Inverse(),
                     landmark)});
    }
  }
  int AddFound(const Eigen::Vector3d& half_axes = kCube, const std::string& label = "box") {
    const int truth = AddTruth(half_axes);
    Detect(truth, AddLandmark(Truth(truth), label));
    return truth;
  }

  MapQuality Evaluate(AlignmentChoice alignment = AlignmentChoice::kAuto) {
    std::ranges::stable_sort(sequence_.detections, {}, &Detection::frame_index);
    std::vector<Rigid3d> poses;
    for (const Frame& frame : sequence_.frames) poses.push_back(frame.world_from_camera);
    return EvaluateMapQuality(sequence_, estimates_, poses, {sequence_.planes[0].plane_in_world},
                              alignment)
        .value();
  }
  const TrueObjectRow& RowOf(const MapQuality& quality, int truth) const {
    return *std::ranges::find(quality.objects, truth, &TrueObjectRow::true_index);
  }
  void MakeAWallOfMistakes();
  void Shuffle();

  Sequence sequence_;
  std::vector<ObjectEstimate> estimates_;
};

// 15 true objects: 4 are found, each of the others is missed for a reason of its own; 14 landmarks.
void MapQualityTest::MakeAWallOfMistakes() {
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
  estimates_[static_cast<size_t>(not_estimated)].failure = "too_few_views";
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

TEST_F(MapQualityTest, AWallOfMistakesHasItsCountsAndReasons) {
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
  EXPECT_EQ(RowOf(quality, 6).miss->detail, "boxes in use in 0 frames; left out: near_border 6");
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
    EXPECT_NEAR(a.of_found.up_deg_mean.value(), b.of_found.up_deg_mean.value(), 1e-5);
    EXPECT_NEAR(a.of_found.yaw_deg_mean.value(), b.of_found.yaw_deg_mean.value(), 1e-5);
    EXPECT_NEAR(a.precision.value(), b.precision.value(), 1e-12);
    EXPECT_NEAR(a.f1_of_detectable.value(), b.f1_of_detectable.value(), 1e-12);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(a.of_found.log_size_mean[axis].value(), b.of_found.log_size_mean[axis].value(),
                  1e-9);
    }
  }
  EXPECT_NEAR(one.in_frames.iou_in_frames.value(), other.in_frames.iou_in_frames.value(), 1e-9);
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

TEST_F(MapQualityTest, MotionAndScaleOfAWholeMapChangeNothing) {
  MakeAWallOfMistakes();
  const MapQuality at_home = Evaluate(AlignmentChoice::kNone);
  ExpectSameFigures(at_home, Evaluate(AlignmentChoice::kRigid));
  for (const double scale : {1.0, 0.2, 7.0}) {
    const Alignment away{AlignmentKind::kSimilarity, CameraPath::kGeneral, scale, RandomRigid(),
                         kFrames};
    const auto sequence = sequence_;
    const auto estimates = estimates_;
    for (Frame& frame : sequence_.frames) {
      frame.world_from_camera = away.Apply(frame.world_from_camera);
    }
    for (ObjectEstimate& estimate : estimates_) {
      if (estimate.landmark_in_world) {
        estimate.landmark_in_world = away.Apply(*estimate.landmark_in_world);
      }
    }
    sequence_.planes[0].plane_in_world = away.Apply(sequence_.planes[0].plane_in_world);
    const MapQuality similar = Evaluate(AlignmentChoice::kSimilarity);
    ExpectSameFigures(at_home, similar);
    EXPECT_NEAR(similar.alignments.of_segment.at(0).scale, 1.0 / scale, 1e-9);
    if (scale == 1.0) ExpectSameFigures(at_home, Evaluate(AlignmentChoice::kRigid));
    sequence_ = sequence;
    estimates_ = estimates;
  }
}

// Objects, true objects and detections in another order, with other ids.
void MapQualityTest::Shuffle() {
  const auto shuffled = [](size_t count) {
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, TestRandom());
    return order;  // old by new
  };
  const Sequence old = sequence_;
  const auto object_order = shuffled(old.objects.size());
  for (size_t i = 0; i < object_order.size(); ++i) {
    sequence_.objects[i] = old.objects[object_order[i]];
    sequence_.objects[i].id = 500 + static_cast<int>(i);
  }
  const auto new_index = [&](int index) {
    return static_cast<int>(std::ranges::find(object_order, static_cast<size_t>(index)) -
                            object_order.begin());
  };
  for (ObjectEstimate& estimate : estimates_)
    estimate.object_index = new_index(estimate.object_index);
  for (Detection& detection : sequence_.detections) {
    detection.object_index = new_index(detection.object_index);
  }
  const auto truth_order = shuffled(old.true_objects.size());
  std::map<int, int> new_id;
  for (size_t i = 0; i < truth_order.size(); ++i) {
    sequence_.true_objects[i] = old.true_objects[truth_order[i]];
    new_id[sequence_.true_objects[i].id] = static_cast<int>(i);
    sequence_.true_objects[i].id = static_cast<int>(i);
  }
  for (Detection& detection : sequence_.detections) {
    if (detection.true_object_id) detection.true_object_id = new_id.at(*detection.true_object_id);
  }
  std::ranges::shuffle(sequence_.detections, TestRandom());
  std::ranges::shuffle(sequence_.rejected, TestRandom());
  std::ranges::shuffle(estimates_, TestRandom());
  std::ranges::reverse(sequence_.ignored);
}

TEST_F(MapQualityTest, OrderDoesNotMatter) {
  MakeAWallOfMistakes();
  const MapQuality before = Evaluate();
  for (int trial = 0; trial < 10; ++trial) {
    Shuffle();
    ExpectSameSummary(before, Evaluate());
  }
}

TEST_F(MapQualityTest, NamesDoNotMatter) {
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

// The camera's estimate drifts, and what it sees with it.
TEST_F(MapQualityTest, DriftCountsInTheWorldAndNotInFrames) {
  AddFound();
  AddFound({0.3, 0.1, 0.2});
  EXPECT_NEAR(Evaluate().in_frames.iou_in_frames.value(), 1.0, 1e-9);
  const Rigid3d drift{ExpRotation({0, 0, 0.02}), {-0.03, 0, 0}};
  for (Frame& frame : sequence_.frames) frame.world_from_camera = drift * frame.world_from_camera;
  for (ObjectEstimate& estimate : estimates_) {
    estimate.landmark_in_world = Transform(drift, *estimate.landmark_in_world);
  }
  const MapQuality quality = Evaluate(AlignmentChoice::kNone);
  EXPECT_EQ(quality.in_frames.landmarks, 2);
  EXPECT_NEAR(quality.in_frames.iou_in_frames.value(), 1.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.centre_m_in_frames.value(), 0.0, 1e-9);
  EXPECT_LT(quality.in_frames.iou_in_world.value(), 0.7);
  EXPECT_GT(quality.in_frames.centre_m_in_world.value(), 0.05);
  EXPECT_EQ(quality.landmarks[0].in_frames->observations, kFrames);
}

TEST_F(MapQualityTest, WhatDriftHasCarriedAwayIsComparedInFrames) {
  AddFound();
  const Rigid3d drift{Eigen::Quaterniond::Identity(), {0.3, 0, 0}};
  for (Frame& frame : sequence_.frames) frame.world_from_camera = drift * frame.world_from_camera;
  estimates_[0].landmark_in_world = Transform(drift, *estimates_[0].landmark_in_world);
  const MapQuality quality = Evaluate(AlignmentChoice::kNone);
  EXPECT_EQ(quality.scores[0].found, 0);
  EXPECT_NEAR(quality.in_frames.iou_in_frames.value(), 1.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.iou_in_world.value(), 1.0 / 7.0, 1e-9);
}

// Without true poses, with the truth of each frame, as KITTI has it.
TEST_F(MapQualityTest, TheTruthOfAFrameGoesBeforeThatOfTheWorld) {
  const int truth = AddFound();
  for (Frame& frame : sequence_.frames) frame.true_world_from_camera.reset();
  EXPECT_EQ(Evaluate().in_frames.landmarks, 0);
  SayInFrames(truth, Shifted(truth, {0.2, 0, 0}));
  const MapQuality quality = Evaluate();
  EXPECT_NEAR(quality.in_frames.iou_in_frames.value(), 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.iou_in_world.value(), 1.0, 1e-9);
}

// Boxes in frames of which the dataset does not say that the object is seen are not of it.
TEST_F(MapQualityTest, AnObjectIsNotSeenWhereTheDatasetSaysItOfOtherFramesAlone) {
  const int truth = AddFound();
  EXPECT_EQ(Evaluate().objects[0].detected_frames, kFrames);
  SayInFrames(truth, Truth(truth));
  sequence_.truth_in_frames.resize(2);
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.objects[0].detected_frames, 2);
  EXPECT_FALSE(quality.objects[0].is_detectable);
  EXPECT_EQ(quality.scores[0].found_detectable, 0);
  EXPECT_EQ(quality.scores[0].found, 1);
  EXPECT_EQ(quality.landmarks[0].in_frames->observations, 2);
}

TEST_F(MapQualityTest, ThePlaneOfALandmarkIsComparedWithTheTrueOne) {
  AddFound();
  sequence_.planes[0].plane_in_world = {ExpRotation({0.1, 0, 0}) * Eigen::Vector3d::UnitZ(), 0.0};
  sequence_.planes[0].plane_in_world.offset = -0.3;
  const LandmarkRow& row = Evaluate().landmarks[0];
  EXPECT_NEAR(row.plane->tilt_deg, 18.0 / std::numbers::pi, 1e-9);
  const Eigen::Vector3d foot = Truth(0).Centre() - Eigen::Vector3d(0, 0, 0.2);
  EXPECT_NEAR(row.plane->offset_m, -sequence_.planes[0].plane_in_world.SignedDistance(foot), 1e-12);
}

TEST_F(MapQualityTest, ObjectsThatMoveAreNotLookedFor) {
  AddFound();
  const int moving = AddTruth();
  sequence_.true_objects[static_cast<size_t>(moving)].is_static = false;
  Detect(moving, AddLandmark(Shifted(moving, {0, 9, 0})));
  SayInFrames(moving, Truth(moving));
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.scores[0].true_objects, 1);
  EXPECT_TRUE(quality.misses.empty());
  EXPECT_THAT(quality.false_landmarks, ElementsAre(Pair(MapReason::kMoving, 1)));
}

// A van where cars are asked for: its landmark is neither right nor wrong.
TEST_F(MapQualityTest, OtherLabelsThanThoseAskedForAreIgnored) {
  AddFound();
  const int van = AddFound();
  const int missed_van = AddTruth();
  for (const int index : {van, missed_van}) {
    sequence_.true_objects[static_cast<size_t>(index)].is_ignored = true;
  }
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.scores[0].true_objects, 1);
  EXPECT_EQ(quality.scores[0].landmarks, 2);
  EXPECT_EQ(quality.scores[0].ignored, 1);
  EXPECT_EQ(quality.scores[0].f1, 1.0);
  EXPECT_TRUE(quality.misses.empty());
}

// However well they fit, and at each IoU; and the landmark of a wanted object is not theirs.
TEST_F(MapQualityTest, WhatIsIgnoredDoesNotCompete) {
  const int wanted = AddFound();
  const int van = AddTruth();
  TrueObject& ignored = sequence_.true_objects[static_cast<size_t>(van)];
  ignored.is_ignored = true;
  ignored.truth.landmark_in_world = Shifted(wanted, {0.05, 0, 0});
  estimates_[0].landmark_in_world = Shifted(wanted, {0.04, 0, 0});
  DetectNothing(AddLandmark(Shifted(van, {0.2, 0, 0})));  // IoU 1/3 with the van
  DetectNothing(AddLandmark(Shifted(van, {0.22, 0, 0})));
  const MapQuality quality = Evaluate();
  for (const MapScore& score : quality.scores) {
    EXPECT_EQ(score.found, 1);
    EXPECT_EQ(score.landmarks, 3);
    EXPECT_EQ(score.ignored, 2);
    EXPECT_EQ(score.precision, 1.0);
  }
}

TEST_F(MapQualityTest, ALandmarkOfAWantedObjectIsNotIgnored) {
  const int elsewhere = AddTruth();
  const Landmark landmark = Shifted(elsewhere, {0, 9, 0});
  Detect(elsewhere, AddLandmark(landmark, "mouse"));
  const int found = AddFound();
  DetectNothing(AddLandmark(Shifted(found, {0.1, 0, 0}), "mouse"));
  sequence_.ignored = {{"mouse", std::nullopt}, {std::nullopt, landmark}};
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.scores[0].ignored, 0);
  EXPECT_EQ(quality.false_landmarks.at(MapReason::kDuplicate), 1);
}

// A box that passed the import and was left out by association is lost there.
TEST_F(MapQualityTest, LossesCountWhereTheyHappen) {
  const int truth = AddTruth();
  Reject(truth, RejectingStage::kImport, "near_border");
  std::erase_if(sequence_.rejected, [](const auto& rejected) { return rejected.frame_index < 3; });
  const auto only_first = [&](int frames) {
    Reject(truth, RejectingStage::kAssociate, "too_few_detections");
    std::erase_if(sequence_.rejected, [&](const auto& rejected) {
      return rejected.stage == RejectingStage::kAssociate && rejected.frame_index >= frames;
    });
    return RowOf(Evaluate(), truth).miss->reason;
  };
  AddFound();
  EXPECT_EQ(only_first(0), MapReason::kGated);
  EXPECT_EQ(only_first(1), MapReason::kLostInAssociation);
}

TEST_F(MapQualityTest, BoxesOfALowScoreDetectNothing) {
  const int truth = AddTruth();
  Reject(truth, RejectingStage::kImport, "low_score");
  for (RejectedDetection& rejected : sequence_.rejected) rejected.score = 0.24;
  AddFound();
  EXPECT_EQ(RowOf(Evaluate(), truth).detected_frames, 0);
  for (RejectedDetection& rejected : sequence_.rejected) rejected.score = 0.25;
  EXPECT_EQ(RowOf(Evaluate(), truth).detected_frames, kFrames);
}

// Without true poses the odometry says where objects are seen, and no map.
TEST_F(MapQualityTest, WhatIsDetectableDoesNotDependOnTheMap) {
  AddFound();
  const Rigid3d away{Eigen::Quaterniond::Identity(), {0.9, 0, 0}};
  std::vector<Rigid3d> poses;
  for (Frame& frame : sequence_.frames) {
    frame.true_world_from_camera.reset();
    poses.push_back(away * frame.world_from_camera);
  }
  estimates_[0].landmark_in_world = Transform(away, *estimates_[0].landmark_in_world);
  const auto quality =
      EvaluateMapQuality(sequence_, estimates_, poses, {}, AlignmentChoice::kAuto).value();
  EXPECT_EQ(quality.scores[0].detectable, 1);
  EXPECT_EQ(quality.scores[0].found, 0);
}

// Twice as large, and turned, and elsewhere: none of these alone makes it right.
TEST_F(MapQualityTest, SeveralPartsCanBeWrong) {
  const int truth = AddTruth({0.3, 0.1, 0.2});
  Landmark landmark = RotatedAboutZ(Shifted(truth, {0.3, 0.2, 0.3}), 1.0);
  landmark.half_axes *= 2.0;
  Detect(truth, AddLandmark(landmark));
  EXPECT_EQ(RowOf(Evaluate(), truth).miss->reason, MapReason::kWrongInSeveral);
}

// The map's plane is tilted into the landmark's height, or the landmark is off the true plane.
TEST_F(MapQualityTest, AWrongPlaneIsNotAWrongHeight) {
  const int truth = AddTruth();
  Detect(truth, AddLandmark(Shifted(truth, {0, 0, 0.3})));
  EXPECT_EQ(RowOf(Evaluate(), truth).miss->reason, MapReason::kWrongHeight);
  sequence_.planes[0].plane_in_world.offset = -0.3;
  EXPECT_EQ(RowOf(Evaluate(), truth).miss->reason, MapReason::kWrongPlane);
}

TEST_F(MapQualityTest, ALandmarkBeyondAllNumbersIsWrong) {
  const int truth = AddTruth();
  Landmark landmark = Truth(truth);
  landmark.half_axes *= 1e150;
  Detect(truth, AddLandmark(landmark));
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.scores[0].found, 0);
  EXPECT_TRUE(std::isfinite(quality.in_frames.iou_in_frames.value_or(0.0)));
}

// A landmark of things that nobody measured, which touches an object that is missed.
TEST_F(MapQualityTest, BoxesOfNothingKnownAreBackground) {
  AddFound();
  const int missed = AddTruth();
  DetectNothing(AddLandmark(Shifted(missed, {0.3, 0, 0})));
  const MapQuality quality = Evaluate();
  EXPECT_THAT(quality.misses, ElementsAre(Pair(MapReason::kNotDetected, 1)));
  EXPECT_THAT(quality.false_landmarks, ElementsAre(Pair(MapReason::kBackground, 1)));
  EXPECT_EQ(quality.in_frames.landmarks, 1);
}

// A thing inside another: each box of it overlaps that other more.
TEST_F(MapQualityTest, BoxesThatAreTakenForThoseOfAnotherAreJoined) {
  const int outer = AddFound();
  const int inner = AddTruth();
  Landmark& truth = sequence_.true_objects[static_cast<size_t>(inner)].truth.landmark_in_world;
  truth = Truth(outer);
  truth.half_axes *= 0.85;
  const MapQuality quality = Evaluate();
  EXPECT_TRUE(RowOf(quality, inner).is_detectable);
  EXPECT_EQ(RowOf(quality, inner).miss->reason, MapReason::kJoined);
}

TEST_F(MapQualityTest, AMapWithoutLandmarksMissesAll) {
  AddFound();
  const std::vector<Rigid3d> poses(kFrames);
  const auto empty = EvaluateMapQuality(sequence_, {}, poses, {}, AlignmentChoice::kNone);
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->scores[0].found, 0);
  EXPECT_EQ(empty->scores[0].recall, 0.0);
  EXPECT_FALSE(empty->scores[0].precision);
  EXPECT_EQ(empty->misses.at(MapReason::kNoLandmark), 1);
}

TEST_F(MapQualityTest, ThereIsNoneWithoutTruth) {
  AddFound();
  const std::vector<Rigid3d> poses(kFrames);
  sequence_.true_objects[0].is_static = false;
  EXPECT_FALSE(EvaluateMapQuality(sequence_, estimates_, poses, {}, AlignmentChoice::kNone));
}

// The best sum over all ways to match the rows from `row` on.
double BestSum(const Eigen::MatrixXd& ious, double min_iou, Eigen::Index row,
               std::vector<bool> taken) {
  if (row == ious.rows()) return 0.0;
  double best = BestSum(ious, min_iou, row + 1, taken);
  for (Eigen::Index column = 0; column < ious.cols(); ++column) {
    const auto place = static_cast<size_t>(column);
    if (taken[place] || ious(row, column) < min_iou) continue;
    taken[place] = true;
    best = std::max(best, ious(row, column) + BestSum(ious, min_iou, row + 1, taken));
    taken[place] = false;
  }
  return best;
}

TEST(MatchByIou, IsTheBestOfAllWays) {
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXd ious(trial % 6, (trial / 6) % 6);
    for (Eigen::Index i = 0; i < ious.size(); ++i) ious.data()[i] = RandomUniform(0.0, 1.0);
    const std::vector<int> matched = MatchByIou(ious, 0.25);
    double sum = 0.0;
    for (size_t row = 0; row < matched.size(); ++row) {
      if (matched[row] < 0) continue;
      const double iou = ious(static_cast<Eigen::Index>(row), matched[row]);
      EXPECT_GE(iou, 0.25);
      sum += iou;
    }
    const std::vector<bool> none(static_cast<size_t>(ious.cols()), false);
    EXPECT_NEAR(sum, BestSum(ious, 0.25, 0, none), 1e-12) << trial;
  }
}

TEST(IsIgnored, ByLabelOrVolumeOrBoth) {
  const Landmark volume{{}, {1.0, 1.0, 1.0}};
  const AlignedLandmark inside{
      0, 0, {{Eigen::Quaterniond::Identity(), {0.9, 0, 0}}, {0.4, 0.4, 0.4}}};
  const AlignedLandmark outside{
      0, 0, {{Eigen::Quaterniond::Identity(), {1.1, 0, 0}}, {0.4, 0.4, 0.4}}};
  const AlignedLandmark larger{0, 0, {{}, {1.5, 1.5, 1.5}}};       // IoU 8 / 27
  const AlignedLandmark much_larger{0, 0, {{}, {1.6, 1.6, 1.6}}};  // IoU 0.244
  const auto is_ignored = [](const std::vector<IgnoredThings>& ignored, const std::string& label,
                             const AlignedLandmark& landmark) {
    Sequence sequence;
    sequence.ignored = ignored;
    return IsIgnored(sequence, label, landmark);
  };
  EXPECT_TRUE(is_ignored({{std::nullopt, volume}}, "book", larger));
  EXPECT_FALSE(is_ignored({{std::nullopt, volume}}, "book", much_larger));
  EXPECT_TRUE(is_ignored({{"cup", std::nullopt}}, "cup", outside));
  EXPECT_TRUE(is_ignored({{"Teddy_Bear", std::nullopt}}, "teddy bear", outside));
  EXPECT_FALSE(is_ignored({{"cup", std::nullopt}}, "book", inside));
  EXPECT_TRUE(is_ignored({{std::nullopt, volume}}, "book", inside));
  EXPECT_FALSE(is_ignored({{std::nullopt, volume}}, "book", outside));
  EXPECT_FALSE(is_ignored({{"cup", volume}}, "book", inside));
  EXPECT_TRUE(is_ignored({{"cup", volume}, {"book", volume}}, "book", inside));
  EXPECT_FALSE(is_ignored({}, "book", inside));
}

TEST(IsIgnored, ByATrueObjectOfItsSegmentThatIs) {
  Sequence sequence;
  sequence.true_objects = {{1, "van", {Landmark{{}, {1.0, 1.0, 1.0}}}, 0, true, true}};
  AlignedLandmark landmark{0, 0, {{Eigen::Quaterniond::Identity(), {0.9, 0, 0}}, {0.4, 0.4, 0.4}}};
  EXPECT_TRUE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 1;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 0;
  sequence.true_objects[0].is_ignored = false;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
}

}  // namespace
}  // namespace soslam
