// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/back_end.h"

#include <gtest/gtest.h>

#include <limits>

#include "soslam/base/error.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/single_frame.h"
#include "soslam/mapping/initial_landmarks.h"
#include "support/cuboid_map.h"
#include "support/scene.h"

namespace soslam {
namespace {

BackEndInput EllipsoidInput(const Sequence& sequence) {
  BackEndInput input{sequence, {}, {}};
  for (const Object& object : sequence.objects) {
    input.initial_landmarks.push_back(object.ground_truth->landmark_in_world);
  }
  input.priors = ObjectPriors(sequence, SemanticTable(), RatioPrior::kGroundTruth);
  return input;
}

// Every residual of the paper is zero at the ground truth of a noise-free sequence.
TEST(BackEnd, CostsNothingAtTheTruth) {
  const Sequence sequence = SyntheticSequence(RandomScene(5, 5, 20), false);
  OptimiseOptions options;
  options.variances = {.detection_dm4 = 1e4, .support_angle_deg2 = 1, .support_tangency_dm4 = 1e4};
  const MapEstimate map = OptimiseMap(EllipsoidInput(sequence), options);
  EXPECT_LT(map.solver.initial_cost, 1e-18 * 1000);  // residuals below 1e-9, a few hundred of them
  EXPECT_EQ(map.solver.residuals.at("odometry"), 19);
  EXPECT_EQ(map.solver.residuals.at("support"), 5);
  EXPECT_EQ(map.solver.residuals.at("ratio"), 5);
  EXPECT_EQ(map.solver.residuals.at("detection"), static_cast<int>(sequence.detections.size()));
}

TEST(BackEnd, ComesBackFromADisturbedStart) {
  const Sequence sequence = SyntheticSequence(RandomScene(5, 5, 20), false);
  BackEndInput input = EllipsoidInput(sequence);
  Disturb(&input);
  const Metrics metrics = EvaluateMap(sequence, OptimiseMap(input, OptimiseOptions()));
  for (const ObjectMetrics& object : metrics.objects) EXPECT_GT(object.iou, 0.99);
}

TEST(BackEnd, MovesWithTheWorld) {
  const Sequence sequence = WithBoxNoise(SyntheticSequence(RandomScene(5, 4, 10), false), 5.0);
  ExpectThatTheMapMovesWithTheWorld(EllipsoidInput(sequence), OptimiseOptions(), 1e-5, 0.98);
}

TEST(BackEnd, SaysWhichObjectHasNoStart) {
  const Sequence sequence = SyntheticSequence(RandomScene(5, 3, 10), false);
  BackEndInput input = EllipsoidInput(sequence);
  input.initial_landmarks[1].reset();
  const MapEstimate map = OptimiseMap(input, OptimiseOptions());
  EXPECT_EQ(map.objects[1].failure, "no_start");
  EXPECT_FALSE(map.objects[1].landmark_in_world);
  EXPECT_TRUE(map.objects[0].landmark_in_world);
  EXPECT_GT(map.solver.gated.at("detection_of_object_without_start"), 0);
}

TEST(BackEnd, GatesDetectionsOfLandmarksBehindTheCamera) {
  const Sequence sequence = SyntheticSequence(RandomScene(5, 3, 10), false);
  BackEndInput input = EllipsoidInput(sequence);
  const Rigid3d& camera = sequence.frames.front().world_from_camera;
  input.initial_landmarks[0]->frame_from_object.translation = camera * Eigen::Vector3d(0, 0, -3);
  const MapEstimate map = OptimiseMap(input, OptimiseOptions());
  EXPECT_GT(map.solver.gated.at("landmark_behind_camera"), 0);
}

TEST(BackEnd, ALandmarkWithoutResidualsStaysAndHasNoCovariance) {
  Sequence sequence = SyntheticSequence(RandomScene(5, 3, 10), false);
  std::erase_if(sequence.detections, [](const Detection& d) { return d.object_index == 0; });
  const BackEndInput input = EllipsoidInput(sequence);
  OptimiseOptions options;
  options.support = false;
  options.ratio = false;
  const MapEstimate map = OptimiseMap(input, options);
  EXPECT_EQ(map.objects[0].landmark_in_world->Centre(), input.initial_landmarks[0]->Centre());
  EXPECT_FALSE(map.objects[0].covariance);
  EXPECT_GT(map.solver.gated.at("covariance_of_undetermined_problem"), 0);
}

TEST(BackEnd, RefusesAnInitialLandmarkWhoseCostIsNotDefined) {
  const Sequence sequence = SyntheticSequence(RandomScene(5, 3, 10), false);
  BackEndInput input = EllipsoidInput(sequence);
  input.initial_landmarks[0]->half_axes.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(OptimiseMap(input, OptimiseOptions()), InputError);
}

// Other views tell apart what explains one box equally well.
TEST(ChooseInitialLandmarks, TakesTheHypothesisThatFitsTheOtherViews) {
  const Sequence sequence = SyntheticSequence(RandomScene(11, 5, 20), false);
  const auto ratios = ObjectRatios(sequence, SemanticTable(), RatioPrior::kGroundTruth);
  LandmarkEstimates estimates = InitialiseSingleFrame(sequence, ratios, SingleFrameOptions(), 1);
  for (auto& observation : estimates.observations) {
    std::reverse(observation.hypotheses.begin(), observation.hypotheses.end());
  }
  const auto initial_landmarks = ChooseInitialLandmarks(sequence, estimates);
  for (size_t i = 0; i < initial_landmarks.size(); ++i) {
    ASSERT_TRUE(initial_landmarks[i]);
    EXPECT_GT(BoxIou(*initial_landmarks[i], sequence.objects[i].ground_truth->landmark_in_world),
              0.99);
  }
}

}  // namespace
}  // namespace soslam
