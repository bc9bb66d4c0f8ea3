// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/dataset/gate.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/synthesis/simulate.h"
#include "support/scene.h"

namespace soslam {
namespace {

// Exact boxes of cuboids, every other frame held out, and the true landmarks.
class HeldOutTest : public testing::Test {
 protected:
  HeldOutTest() {
    for (size_t i = 0; i < sequence_.objects.size(); ++i) {
      Landmark truth = sequence_.objects[i].ground_truth->landmark_in_world;
      truth.shape_exponents = kCuboidExponent;
      estimates_.push_back({static_cast<int>(i), 0, truth, {}, ""});
    }
    for (const HeldOutFrame& held_out : sequence_.held_out) {
      poses_.push_back(*held_out.frame.true_world_from_camera);
      detections_ += static_cast<int>(held_out.boxes.size());
    }
  }

  HeldOutMetrics Evaluate() const { return *EvaluateHeldOut(sequence_, estimates_, poses_); }

  Sequence sequence_ = HoldOutFrames(SyntheticSequence(RandomScene(7, 4, 24, {Shape::kBox}), false),
                                     HeldOutFrames::kOdd);
  std::vector<ObjectEstimate> estimates_;
  std::vector<Rigid3d> poses_;
  int detections_ = 0;
};

TEST_F(HeldOutTest, TheTruthExplainsAll) {
  const HeldOutMetrics metrics = Evaluate();
  EXPECT_EQ(metrics.frames, 12);
  EXPECT_GT(metrics.detections, 8);
  EXPECT_EQ(metrics.detections, detections_);
  EXPECT_EQ(metrics.detections_matched, detections_);
  EXPECT_NEAR(*metrics.iou_mean, 1.0, 1e-3);
  EXPECT_NEAR(*metrics.iou_mean_of_detections, 1.0, 1e-3);
  EXPECT_GE(metrics.in_sight, metrics.in_sight_matched);
  EXPECT_EQ(metrics.objects.size(), 4u);
}

TEST_F(HeldOutTest, DetectionsWithoutALandmarkCount) {
  const int lost = Evaluate().objects.front().matched;
  ASSERT_GT(lost, 0);
  estimates_.front().landmark_in_world.reset();
  const HeldOutMetrics metrics = Evaluate();
  EXPECT_EQ(metrics.detections_matched, detections_ - lost);
  EXPECT_NEAR(*metrics.iou_mean, 1.0, 1e-3);
  EXPECT_NEAR(*metrics.iou_mean_of_detections,
              static_cast<double>(detections_ - lost) / detections_, 1e-3);
  EXPECT_EQ(metrics.objects.size(), 3u);
}

TEST_F(HeldOutTest, OfTwoLandmarksAtOnePlaceOneMatches) {
  const HeldOutMetrics before = Evaluate();
  estimates_.push_back(estimates_.front());
  const HeldOutMetrics metrics = Evaluate();
  EXPECT_EQ(metrics.detections_matched, before.detections_matched);
  EXPECT_EQ(metrics.in_sight, before.in_sight + before.objects.front().in_sight);
  EXPECT_EQ(metrics.in_sight_matched, before.in_sight_matched);
}

TEST_F(HeldOutTest, LabelsMustBeEqual) {
  for (HeldOutFrame& held_out : sequence_.held_out) {
    for (auto& labelled : held_out.boxes) labelled.label += " of another kind";
  }
  const HeldOutMetrics metrics = Evaluate();
  EXPECT_EQ(metrics.detections_matched, 0);
  EXPECT_FALSE(metrics.iou_mean);
  EXPECT_EQ(*metrics.iou_mean_of_detections, 0.0);
}

// What the map says of one frame moves the held-out frame after it, and no other.
TEST_F(HeldOutTest, PosesAreThoseOfTheFrameBeforeAndTheOdometry) {
  std::vector<Rigid3d> map = PosesOf(sequence_);
  constexpr size_t kFrame = 4;
  const Eigen::Vector3d shift(0.1, 0.2, 0.3);
  map[kFrame].translation += shift;
  const std::vector<Rigid3d> poses = HeldOutPoses(sequence_, map);
  for (size_t i = 0; i < poses.size(); ++i) {
    const Frame& frame = sequence_.held_out[i].frame;
    const bool is_after = frame.id == sequence_.frames[kFrame].id + 1;
    const Eigen::Vector3d moved = poses[i].translation - frame.world_from_camera.translation;
    EXPECT_LT((moved - (is_after ? shift : Eigen::Vector3d(0, 0, 0))).norm(), 1e-9) << frame.id;
  }
}

// Another segment has another world: its landmarks are in sight of no frame of this one.
TEST_F(HeldOutTest, LandmarksAreComparedInTheirOwnSegment) {
  for (HeldOutFrame& held_out : sequence_.held_out) held_out.frame.segment = 1;
  const HeldOutMetrics metrics = Evaluate();
  EXPECT_EQ(metrics.in_sight, 0);
  EXPECT_EQ(metrics.detections_matched, 0);
  EXPECT_EQ(metrics.detections, detections_);
}

}  // namespace
}  // namespace soslam
