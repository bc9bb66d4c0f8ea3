// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <numbers>

#include "soslam/base/assignment.h"
#include "soslam/evaluation/map_reasons.h"
#include "support/map_quality_fixture.h"

namespace soslam {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Pair;

// The camera's estimate drifts, and what it sees with it.
TEST_F(MapQualityTest, DriftCountsInTheWorldAndNotInFrames) {
  AddFound();
  AddFound({0.3, 0.1, 0.2});
  EXPECT_NEAR(Evaluate().in_frames.iou_mean.value(), 1.0, 1e-9);
  Move({AlignmentKind::kRigid,
        CameraPath::kGeneral,
        1.0,
        {ExpRotation({0, 0, 0.02}), {-0.03, 0, 0}}});
  const MapQuality quality = Evaluate(AlignmentKind::kNone);
  EXPECT_EQ(quality.in_frames.landmarks, 2);
  EXPECT_NEAR(quality.in_frames.iou_mean.value(), 1.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.centre_m_median.value(), 0.0, 1e-9);
  EXPECT_LT(quality.in_frames.iou_mean_in_world.value(), 0.7);
  EXPECT_GT(quality.in_frames.centre_m_median_in_world.value(), 0.05);
  EXPECT_EQ(quality.landmarks[0].in_frames->observations, kFrames);
}

TEST_F(MapQualityTest, WhatIfIsOfFramesAndAMeanOfLandmarks) {
  AddFound();
  const int half = AddTruth();
  Detect(half, AddLandmark(Shifted(half, {0.2, 0, 0})));
  Move({AlignmentKind::kRigid,
        CameraPath::kGeneral,
        1.0,
        {ExpRotation({0, 0, 0.02}), {-0.03, 0, 0}}});
  const MapQuality quality = Evaluate(AlignmentKind::kNone);
  const WhatIf shifted = quality.landmarks[1].in_frames.value().what_if;
  EXPECT_NEAR(shifted.place, 1.0, 1e-9);
  for (const double iou : {shifted.yaw, shifted.quarter_turn, shifted.size}) {
    EXPECT_NEAR(iou, 1.0 / 3.0, 1e-9);
  }
  EXPECT_NEAR(quality.in_frames.what_if->place, 1.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.what_if->yaw, 2.0 / 3.0, 1e-9);
}

TEST_F(MapQualityTest, FrontsAreThoseOfFoundObjectsOfTheSameLabel) {
  AddFound();
  AddFound(kCube, "chair");
  EXPECT_FALSE(Evaluate().scores[0].of_found.fronts);
  for (ObjectEstimate& estimate : estimates_) {
    estimate.front_probability = 0.95;
    estimate.landmark_in_world = RotatedAboutZ(*estimate.landmark_in_world, std::numbers::pi);
  }
  Move({AlignmentKind::kRigid, CameraPath::kGeneral, 1.0, {ExpRotation({0, 0, 1.0}), {}}});
  const MapQuality quality = Evaluate(AlignmentKind::kRigid);
  EXPECT_NEAR(quality.landmarks[0].front.deg.value(), 180.0, 1e-6);
  EXPECT_FALSE(quality.landmarks[1].front.deg);
  EXPECT_EQ(quality.scores[0].of_found.fronts->known_but_wrong, 1);
}

// Precisions 1, 1/2, 2/3, 3/4 at recalls 1/4, 1/4, 2/4, 3/4: the envelope is 1, then 3/4.
TEST_F(MapQualityTest, AveragePrecisionIsTheAreaUnderTheEnvelope) {
  for (int i = 0; i < 3; ++i) AddFound();
  AddTruth();
  const Landmark nowhere = Shifted(0, {0, 9, 0});
  DetectNothing(AddLandmark(nowhere));
  DetectNothing(AddLandmark(Shifted(0, {0, 12, 0}), "mouse"));
  sequence_.ignored = {{"mouse", std::nullopt}};
  const auto average_precision = [&](const std::vector<double>& scores) {
    for (Detection& detection : sequence_.detections) {
      detection.score = scores[detection.object_index];
    }
    return Evaluate().scores[0].average_precision.value();
  };
  EXPECT_NEAR(average_precision({0.9, 0.7, 0.6, 0.8, 0.95}), (1.0 + 0.75 + 0.75) / 4.0, 1e-12);
  EXPECT_NEAR(average_precision({0.7, 0.9, 0.8, 0.6, 0.1}), 3.0 / 4.0, 1e-12);
  // No landmark comes before others of its score.
  EXPECT_NEAR(average_precision({0.9, 0.7, 0.6, 0.9, 0.1}), 3.0 * 0.75 / 4.0, 1e-12);
}

TEST_F(MapQualityTest, TheScoreOfALandmarkCountsFramesWithoutABox) {
  const int truth = AddTruth();
  Detect(truth, AddLandmark(Truth(truth)), 0, kFrames / 2);
  for (Detection& detection : sequence_.detections) detection.score = 0.8;
  EXPECT_NEAR(Evaluate().landmarks[0].score, 0.4, 1e-12);
}

TEST_F(MapQualityTest, UpOfAnOwnWorldIsComparedWithThatOfMostTrueObjects) {
  for (int i = 0; i < 3; ++i) AddFound();
  sequence_.true_objects[1].truth.landmark_in_world.frame_from_object.rotation =
      ExpRotation({0.3, 0, 0});
  Move({AlignmentKind::kSimilarity, CameraPath::kGeneral, 2.0, {ExpRotation({0.2, 0.1, 1}), {}}});
  Eigen::Vector3d& up = sequence_.planes[0].plane_in_world.normal;
  up = ExpRotation(1.5 * up.unitOrthogonal()) * up;
  const auto up_error_deg = [&] { return Evaluate().alignments.of_segment.at(0).up_error_deg; };
  EXPECT_EQ(up_error_deg(), std::nullopt) << "the world is not said to be another";
  sequence_.odometry_world = OdometryWorld::kOwnWithScale;
  EXPECT_NEAR(up_error_deg().value(), 270.0 / std::numbers::pi, 1e-6);
  for (TrueObject& object : sequence_.true_objects) {
    object.truth.landmark_in_world.rests_on = RestingFace::kSide;
  }
  EXPECT_EQ(up_error_deg(), std::nullopt) << "no object says where up is";
}

// Without true poses, with the truth of each frame, as KITTI has it.
TEST_F(MapQualityTest, TheTruthOfAFrameGoesBeforeThatOfTheWorld) {
  const int truth = AddFound();
  for (Frame& frame : sequence_.frames) frame.true_world_from_camera.reset();
  EXPECT_EQ(Evaluate().in_frames.landmarks, 0);
  EXPECT_FALSE(Evaluate().in_frames.what_if);
  SayInFrames(truth, Shifted(truth, {0.2, 0, 0}));
  const MapQuality quality = Evaluate();
  EXPECT_NEAR(quality.in_frames.iou_mean.value(), 1.0 / 3.0, 1e-9);
  EXPECT_NEAR(quality.in_frames.iou_mean_in_world.value(), 1.0, 1e-9);
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
  sequence_.true_objects[moving].is_static = false;
  Detect(moving, AddLandmark(Shifted(moving, {0, 9, 0})));
  SayInFrames(moving, Truth(moving));
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.scores[0].true_objects, 1);
  EXPECT_TRUE(quality.misses.empty());
  EXPECT_THAT(quality.false_landmarks, ElementsAre(Pair(MapReason::kMoving, 1)));
}

// A van where cars are asked for: however well landmarks fit it, at each IoU, they are neither
// right nor wrong, and the landmark of a wanted object is not its.
TEST_F(MapQualityTest, WhatIsIgnoredDoesNotCompete) {
  const int wanted = AddFound();
  const int van = AddTruth();
  TrueObject& ignored = sequence_.true_objects[van];
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
    EXPECT_EQ(score.true_objects, 1);
    EXPECT_EQ(score.f1, 1.0);
  }
  EXPECT_TRUE(quality.misses.empty());
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
      EvaluateMapQuality(sequence_, estimates_, poses, {}, AlignmentKind::kAuto).value();
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
  EXPECT_TRUE(std::isfinite(quality.in_frames.iou_mean.value_or(0.0)));
}

// A map that was made from other boxes may have it.
TEST_F(MapQualityTest, ALandmarkOfAnObjectThatNoBoxShowsIsNotJudged) {
  AddFound();
  AddLandmark(Shifted(AddTruth(), {0, 9, 0}));
  const MapQuality quality = Evaluate();
  EXPECT_EQ(quality.landmarks.size(), 1u);
  EXPECT_TRUE(quality.false_landmarks.empty());
}

TEST_F(MapQualityTest, AMapWithoutLandmarksMissesAll) {
  AddFound();
  const std::vector<Rigid3d> poses(kFrames);
  const auto empty = EvaluateMapQuality(sequence_, {}, poses, {}, AlignmentKind::kNone);
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
  EXPECT_FALSE(EvaluateMapQuality(sequence_, estimates_, poses, {}, AlignmentKind::kNone));
}

// The largest overlap is not in the best sum, unless the threshold leaves no other way.
TEST(MatchByIou, IsTheBestSumOfThoseThatReachTheThreshold) {
  const Eigen::MatrixXd ious{{0.9, 0.1, 0.8}, {0.85, 0.1, 0.1}};
  EXPECT_THAT(MatchByIou(ious, 0.8), ElementsAre(2, 0));
  EXPECT_THAT(MatchByIou(ious, 0.81), ElementsAre(0, kUnassigned));
  EXPECT_THAT(MatchByIou(ious.leftCols(0), 0.8), Each(kUnassigned));
}

AlignedLandmark CubeAt(double x, double half_axis) {
  return {
      0, 0, {{Eigen::Quaterniond::Identity(), {x, 0, 0}}, Eigen::Vector3d::Constant(half_axis)}};
}

TEST(IsIgnored, ByLabelOrVolumeOrBoth) {
  const Landmark volume{{}, {1.0, 1.0, 1.0}};
  const AlignedLandmark inside = CubeAt(0.9, 0.4), outside = CubeAt(1.1, 0.4);
  const AlignedLandmark larger = CubeAt(0.0, 1.5);       // IoU 8 / 27
  const AlignedLandmark much_larger = CubeAt(0.0, 1.6);  // IoU 0.244
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
  AlignedLandmark landmark = CubeAt(0.9, 0.4);
  EXPECT_TRUE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 1;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 0;
  sequence.true_objects[0].is_ignored = false;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
}

}  // namespace
}  // namespace soslam
