// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/metrics.h"

#include <gtest/gtest.h>

#include <numbers>

#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/trajectory_error.h"
#include "soslam/synthesis/simulate.h"
#include "support/random.h"
#include "support/scene.h"
#include "support/true_map.h"

namespace soslam {
namespace {

Sequence TestSequence() { return SyntheticSequence(RandomScene(7, 4, 12), false); }

LandmarkEstimates TrueEstimates(const Sequence& sequence) {
  LandmarkEstimates estimates;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    estimates.observations.push_back(
        {static_cast<int>(i),
         {{*TrueLandmarkInCamera(sequence, sequence.detections[i]), 0.0}},
         ""});
  }
  return estimates;
}

TEST(Metrics, ArePerfectForTheTruth) {
  Sequence sequence = TestSequence();
  // Single-frame estimates are judged in their camera: drift must not count.
  for (Frame& frame : sequence.frames) frame.world_from_camera = RandomRigid();
  const Metrics metrics = EvaluateLandmarks(sequence, TrueEstimates(sequence));
  EXPECT_EQ(metrics.summary.objects, 4);
  EXPECT_EQ(metrics.summary.observations, static_cast<int>(sequence.detections.size()));
  EXPECT_NEAR(*metrics.summary.iou_mean, 1.0, 1e-6);
  EXPECT_NEAR(*metrics.summary.rotation_deg_mean, 0.0, 1e-4);
  EXPECT_NEAR(*metrics.summary.yaw_error_deg_mean, 0.0, 1e-4);
  EXPECT_EQ(metrics.first_observation->observations, 4);
}

// Means over an object's observations first, then over objects: an object seen often weighs no
// more.
TEST(Metrics, AverageOverObservationsThenObjects) {
  const Sequence sequence = TestSequence();
  LandmarkEstimates estimates = TrueEstimates(sequence);
  int failed_object = sequence.detections.front().object_index;
  int failed = 0;
  for (auto& observation : estimates.observations) {
    const auto& detection = sequence.detections[observation.detection_index];
    if (detection.object_index != failed_object) continue;
    observation.hypotheses.clear();
    ++failed;
  }
  ASSERT_GT(failed, 0);
  const Metrics metrics = EvaluateLandmarks(sequence, estimates);
  EXPECT_EQ(metrics.summary.objects, 4);
  EXPECT_NEAR(*metrics.summary.iou_mean, 0.75, 1e-6);  // no estimate: IoU 0
  EXPECT_NEAR(metrics.summary.what_if.value().size, 0.75, 1e-6);
  EXPECT_NEAR(*metrics.summary.iou_median, 1.0, 1e-6);
  EXPECT_NEAR(*metrics.summary.rotation_deg_mean, 0.0, 1e-4);  // over those that have one
}

TEST(Metrics, ARoundObjectTakesTheEstimatesYawAndHasNoRotation) {
  GroundTruth truth;
  truth.landmark_in_world = {Rigid3d(), {0.5, 0.5, 1.0}};
  truth.rotationally_symmetric = true;
  const Landmark estimate = RotatedAboutZ(truth.landmark_in_world, 0.7);
  const LandmarkErrors errors = CompareLandmarks(estimate, truth, truth.landmark_in_world);
  EXPECT_NEAR(errors.iou, 1.0, 1e-9);
  EXPECT_FALSE(errors.rotation_deg);
  EXPECT_FALSE(errors.yaw_deg);
  truth.rotationally_symmetric = false;
  EXPECT_LT(CompareLandmarks(estimate, truth, truth.landmark_in_world).iou, 0.9);
}

// An object that moves has a truth of its own in each frame.
TEST(Metrics, TheTruthOfADetectionGoesBeforeThatOfItsObject) {
  Sequence sequence = TestSequence();
  LandmarkEstimates estimates = TrueEstimates(sequence);
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    if (sequence.detections[i].object_index != 1) continue;
    Landmark& estimate = estimates.observations[i].hypotheses[0].landmark_in_camera;
    estimate.frame_from_object.translation +=
        Eigen::Vector3d(0.0, 0.0, 10.0 + 0.1 * static_cast<double>(i));
    sequence.detections[i].true_landmark_in_camera = estimate;
  }
  sequence.objects[1].is_static = false;
  const Metrics metrics = EvaluateLandmarks(sequence, estimates);
  EXPECT_EQ(metrics.summary.objects, 4);
  EXPECT_NEAR(*metrics.summary.iou_mean, 1.0, 1e-6);
  for (Detection& detection : sequence.detections) detection.true_landmark_in_camera.reset();
  EXPECT_NEAR(*EvaluateLandmarks(sequence, estimates).summary.iou_mean, 0.75, 1e-6);
}

TEST(Metrics, AnObjectThatMovesHasNoPlaceInAMap) {
  Sequence sequence = TestSequence();
  sequence.objects[2].is_static = false;
  MapEstimate map = TrueMap(sequence);
  map.objects[2].landmark_in_world.reset();
  const Metrics metrics = EvaluateMap(sequence, map);
  EXPECT_EQ(metrics.summary.objects, 3);
  EXPECT_NEAR(*metrics.summary.iou_mean, 1.0, 1e-6);
}

TEST(Metrics, FrontsAreThoseOfMapsThatSayThem) {
  Sequence sequence = TestSequence();
  for (Object& object : sequence.objects) {
    object.ground_truth->rotationally_symmetric = object.ground_truth->mirror_symmetric_yz = false;
  }
  MapEstimate map = TrueMap(sequence);
  EXPECT_FALSE(EvaluateMap(sequence, map).summary.fronts);
  map.objects[1].front_probability = 1.0;
  map.objects[2].front_probability = 0.5;
  map.objects[2].landmark_in_world =
      RotatedAboutZ(*map.objects[2].landmark_in_world, std::numbers::pi);
  const Metrics metrics = EvaluateMap(sequence, map);
  EXPECT_FALSE(metrics.objects[0].front.deg);
  EXPECT_NEAR(metrics.objects[1].front.deg.value(), 0.0, 1e-9);
  EXPECT_NEAR(metrics.objects[2].front.deg.value(), 180.0, 1e-9);
  EXPECT_NEAR(metrics.objects[2].yaw_deg.value(), 0.0, 1e-6);
  const FrontSummary fronts = metrics.summary.fronts.value();
  EXPECT_EQ(fronts.objects, 2);
  EXPECT_EQ(fronts.known, 1);
  EXPECT_EQ(fronts.known_but_wrong, 0);
}

TEST(Metrics, TrajectoriesOfSeveralWorldsAreNotCompared) {
  Sequence sequence = TestSequence();
  EXPECT_TRUE(EvaluateMap(sequence, TrueMap(sequence)).trajectory);
  sequence.frames.back().segment = 1;
  EXPECT_FALSE(EvaluateMap(sequence, TrueMap(sequence)).trajectory);
}

TEST(Metrics, AnObjectThatWasNotObservedDoesNotCount) {
  Sequence sequence = TestSequence();
  std::erase_if(sequence.detections, [](const auto& d) { return d.object_index == 0; });
  const Metrics metrics = EvaluateLandmarks(sequence, TrueEstimates(sequence));
  EXPECT_EQ(metrics.summary.objects, 3);
  EXPECT_EQ(metrics.objects.size(), 4u);
  EXPECT_NEAR(*metrics.summary.iou_mean, 1.0, 1e-6);
}

// Four corners of a square, two opposite ones lifted by 0.1 m and two lowered: no rigid motion
// helps, and one of the whole does not count.
TEST(AbsoluteTrajectoryError, IsTheRootMeanSquareDistance) {
  const Rigid3d motion = RandomRigid();
  std::vector<PosePair> pairs(4);
  for (size_t i = 0; i < 4; ++i) {
    const double x = i < 2 ? 1.0 : -1.0, y = i % 3 == 0 ? 1.0 : -1.0;
    pairs[i].truth.translation = {x, y, 0.0};
    pairs[i].estimated.translation = motion * Eigen::Vector3d(x, y, 0.1 * x * y);
  }
  EXPECT_NEAR(*AbsoluteTrajectoryError(pairs), 0.1, 1e-9);
  pairs.resize(2);
  EXPECT_FALSE(AbsoluteTrajectoryError(pairs));
}

}  // namespace
}  // namespace soslam
