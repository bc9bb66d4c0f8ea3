// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "soslam/initialisation/initialise.h"
#include "support/level_sequence.h"
#include "support/scene.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// Ellipsoids and cuboids, exact boxes.
Sequence Bodies() {
  const Scene scene = RandomScene(4, 6, 8, {Shape::kEllipsoid, Shape::kBox});
  Sequence sequence = SyntheticSequence(scene, false);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].shape != Shape::kBox) continue;
    sequence.objects[i].ground_truth->landmark_in_world.shape_exponents = kCuboidExponent;
  }
  sequence.planes.front().scene_axis_in_world = Eigen::Vector3d::UnitX();
  return sequence;
}

std::vector<std::optional<ShapePrior>> TruePriors(const Sequence& sequence) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    priors.push_back(PriorOf(object.ground_truth->landmark_in_world, kTrueRatioLogSigma));
  }
  return priors;
}

TEST(InitialiseUpright, HasUprightHypothesesInTheOrderOfTheirCosts) {
  const Sequence sequence = Bodies();
  const auto priors = TruePriors(sequence);
  const LandmarkEstimates estimates = InitialiseUpright(sequence, priors, UprightOptions(), 2);
  ASSERT_EQ(estimates.observations.size(), sequence.detections.size());
  EXPECT_TRUE(estimates.objects.empty());
  for (size_t i = 0; i < estimates.observations.size(); ++i) {
    const ObservationEstimate& estimate = estimates.observations[i];
    const Detection& detection = sequence.detections[i];
    EXPECT_EQ(estimate.detection_index, static_cast<int>(i));
    EXPECT_EQ(estimate.failure, "");
    ASSERT_FALSE(estimate.hypotheses.empty());
    EXPECT_TRUE(std::ranges::is_sorted(estimate.hypotheses, {}, &Hypothesis::cost));
    for (const Hypothesis& hypothesis : estimate.hypotheses) {
      const Landmark& landmark = hypothesis.landmark_in_camera;
      EXPECT_EQ(landmark.shape_exponents, priors[detection.object_index]->shape_exponents);
      EXPECT_NEAR(detection.plane_in_camera.SignedDistance(landmark.Centre()),
                  landmark.half_axes.z(), 1e-9);
    }
  }
}

TEST(InitialiseUpright, NamesObjectsWithoutRatio) {
  const Sequence sequence = Bodies();
  auto priors = TruePriors(sequence);
  const int without = sequence.detections.front().object_index;
  priors[without].reset();
  const LandmarkEstimates estimates = InitialiseUpright(sequence, priors, UprightOptions(), 2);
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const bool is_without = sequence.detections[i].object_index == without;
    EXPECT_EQ(estimates.observations[i].failure, is_without ? "no_ratio_for_label" : "");
    EXPECT_EQ(estimates.observations[i].hypotheses.empty(), is_without);
  }
}

// Expects that of two boxes the first has hypotheses, and the second this failure.
void ExpectFailureOfSecond(Sequence sequence, const std::string& failure) {
  sequence.planes = {{0, {Eigen::Vector3d::UnitZ(), 0.0}}};
  const std::vector<std::optional<ShapePrior>> priors(2, ShapePrior());
  const LandmarkEstimates estimates = InitialiseUpright(sequence, priors, UprightOptions(), 1);
  EXPECT_EQ(estimates.observations[0].failure, "");
  EXPECT_FALSE(estimates.observations[0].hypotheses.empty());
  EXPECT_EQ(estimates.observations[1].failure, failure);
  EXPECT_TRUE(estimates.observations[1].hypotheses.empty());
}

TEST(InitialiseUpright, NamesDetectionsThatNoBodyExplains) {
  // The floor's horizon is row 240.
  ExpectFailureOfSecond(LevelSequence({{300, 250, 380, 330}, {300, 100, 380, 180}}), "no_solution");
}

// Two edges leave the size open: no confident answer.
TEST(InitialiseUpright, NamesDetectionsThatAreCutOnTwoSides) {
  Sequence sequence = LevelSequence({{300, 250, 380, 330}, {300, 250, 380, 330}});
  sequence.detections[0].is_one_sided = {true, false, false, false};
  sequence.detections[1].is_one_sided = {true, false, false, true};
  ExpectFailureOfSecond(sequence, "fewer_than_three_measured_edges");
}

// Hypotheses are in the camera frame, and the world's horizontal axes are alike: but for rounding,
// which decides where a fit ends in the kinks of a cuboid's cost.
TEST(InitialiseUpright, DoesNotDependOnWhereTheWorldIsNorOnItsQuarterTurns) {
  const Sequence sequence = Bodies();
  const auto priors = TruePriors(sequence);
  const LandmarkEstimates before = InitialiseUpright(sequence, priors, UprightOptions(), 2);
  const Rigid3d motion = {ExpRotation({0.0, 0.0, 0.5 * std::numbers::pi}), RandomVector(-5, 5)};
  const LandmarkEstimates after =
      InitialiseUpright(TransformSequence(motion, sequence), priors, UprightOptions(), 2);
  for (size_t i = 0; i < before.observations.size(); ++i) {
    const auto& expected = before.observations[i].hypotheses;
    const auto& found = after.observations[i].hypotheses;
    ASSERT_EQ(found.size(), expected.size());
    for (size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].cost, expected[k].cost, 1e-3 * (1.0 + expected[k].cost));
      EXPECT_TRUE(IsSameBody(found[k].landmark_in_camera, expected[k].landmark_in_camera, 1e-3));
    }
  }
}

}  // namespace
}  // namespace soslam
