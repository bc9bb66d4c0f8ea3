// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/estimate_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soslam/geometry/angles.h"
#include "soslam/planes/standing_body.h"
#include "soslam/planes/up_prior.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

constexpr int kFrames = 20;
constexpr double kLogSigma = 0.1;

// Only what the tests' scenes are: cuboids, independent errors.
PlanesOptions ModelOptions() {
  PlanesOptions options;
  options.planes = PlaneSource::kEstimated;
  options.upright.view_correlation_deg = 0.0;
  options.height_sigma_fraction = 0.0;
  options.upright.huber_delta = 1e6;
  return options;
}

Scene CuboidScene(int seed, int objects) {
  return RandomScene(seed, objects, kFrames, {Shape::kBox});
}

UpPrior CamerasUp(const Sequence& sequence) {
  return UpPriorFromCameras(PosesOf(sequence), CameraTilt(), 0.3);
}

PlanesEstimate Estimate(const Sequence& sequence, const PlanesOptions& options = ModelOptions()) {
  const UpPrior up_prior =
      sequence.ground ? UpPrior{sequence.ground->up_information, sequence.ground->up_in_world}
                      : CamerasUp(sequence);
  return FindPlanes(sequence, TrueCuboidPriors(sequence, kLogSigma), up_prior, options, 2).value();
}

// Removes all detections of an object but the first.
void KeepOneDetectionOf(int object_index, Sequence* sequence) {
  bool seen = false;
  std::erase_if(sequence->detections, [&](const Detection& detection) {
    return detection.object_index == object_index && std::exchange(seen, true);
  });
}

// Objects stand on the planes in turn.
void ExpectInTurn(const PlanesEstimate& estimate) {
  for (size_t i = 0; i < estimate.objects.size(); ++i) {
    EXPECT_EQ(estimate.objects[i].plane_index, static_cast<int>(i % 2)) << i;
  }
}

void ExpectGiven(const Sequence& sequence, const PlanesEstimate& estimate, double angle,
                 double offset) {
  for (size_t i = 0; i < estimate.planes.size(); ++i) {
    const auto error = CompareWithGiven(sequence, estimate, static_cast<int>(i));
    ASSERT_TRUE(error);
    EXPECT_LT(error->angle, angle) << "plane " << i;
    EXPECT_LT(std::abs(error->offset), offset) << "plane " << i;
  }
}

// Squared Mahalanobis error of the first plane's three degrees of freedom.
double NormalisedErrorSquared(const Sequence& sequence, const PlanesEstimate& estimate) {
  const EstimatedPlane& plane = estimate.planes[0];
  const Plane& truth = sequence.planes[0].plane_in_world;
  const Eigen::Vector3d turn = truth.normal.cross(plane.plane_in_world.normal);
  const Eigen::Vector3d y = plane.plane_in_world.normal.cross(plane.x_axis_in_world);
  const Eigen::Vector3d error(turn.dot(plane.x_axis_in_world), turn.dot(y),
                              truth.SignedDistance(plane.point_in_world));
  return error.dot(plane.covariance->ldlt().solve(error));
}

TEST(EstimatePlanes, SeparatesAShelfFromTheFloor) {
  for (int seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const Sequence sequence = SyntheticSequence(WithShelf(CuboidScene(seed, 4), 0.25), true);
    const PlanesEstimate estimate = Estimate(sequence);
    ASSERT_EQ(estimate.planes.size(), 2u);
    ExpectGiven(sequence, estimate, 0.2 * kRadPerDeg, 0.005);
    ExpectInTurn(estimate);
    for (const ObjectSupport& object : estimate.objects) {
      EXPECT_EQ(object.reason, SupportReason::kOwnHeight);
    }
  }
}

// Every other object hangs.
std::vector<std::optional<ShapePrior>> WithHanging(std::vector<std::optional<ShapePrior>> priors) {
  for (size_t i = 1; i < priors.size(); i += 2) priors[i]->mount = Mount::kHanging;
  return priors;
}

TEST(EstimatePlanes, WhatHangsHasCeilings) {
  for (int seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const Sequence sequence = SyntheticSequence(WithCeiling(CuboidScene(seed, 8), 1.15), false);
    const PlanesEstimate estimate =
        FindPlanes(sequence, WithHanging(TrueCuboidPriors(sequence, kLogSigma)),
                   CamerasUp(sequence), ModelOptions(), 2)
            .value();
    ASSERT_EQ(estimate.planes.size(), 2u);
    ExpectGiven(sequence, estimate, 0.2 * kRadPerDeg, 0.005);
    ExpectInTurn(estimate);
  }
}

TEST(EstimatePlanes, WhatHasNoPlaneToBeMountedOnHasNoSupport) {
  Sequence sequence = SyntheticSequence(CuboidScene(1, 3), false);
  auto priors = TrueCuboidPriors(sequence, kLogSigma);
  priors[0]->mount = Mount::kOnWall;
  priors[1]->mount = Mount::kHanging;  // seen once: no height
  KeepOneDetectionOf(1, &sequence);
  const PlanesEstimate estimate =
      FindPlanes(sequence, priors, CamerasUp(sequence), ModelOptions(), 2).value();
  EXPECT_EQ(estimate.planes.size(), 1u);
  EXPECT_EQ(estimate.objects[0].reason, SupportReason::kNone);
  EXPECT_EQ(estimate.objects[1].reason, SupportReason::kNone);
  EXPECT_EQ(estimate.objects[2].reason, SupportReason::kOwnHeight);

  const auto detections_before = sequence.detections.size();
  const Sequence with_planes = WithPlanes(sequence, estimate);
  for (const Detection& detection : with_planes.detections) EXPECT_EQ(detection.object_index, 2);
  EXPECT_EQ(with_planes.rejected_detections.at("no_support"),
            static_cast<int>(detections_before - with_planes.detections.size()));
}

// How well one object shows the tilt is another matter: from 0.5 to 11 degrees here. Exact boxes
// leave only the pull of the cameras' up prior, which is less than what the covariance allows for.
TEST(EstimatePlanes, OneObjectIsEnough) {
  for (int seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const Sequence sequence = SyntheticSequence(CuboidScene(seed, 1), false);
    const PlanesEstimate estimate = Estimate(sequence);
    ASSERT_EQ(estimate.planes.size(), 1u);
    EXPECT_TRUE(estimate.settled);
    EXPECT_LT(NormalisedErrorSquared(sequence, estimate), 0.5);
    ExpectGiven(sequence, estimate, 5.0 * kRadPerDeg, 0.01);
  }
}

// The world's axes mean nothing. Tolerance: the grid of tilts is that of the plane's own axes, so
// the solvers stop at slightly different places.
TEST(EstimatePlanes, MovesWithTheWorld) {
  Scene scene = CuboidScene(3, 3);
  scene.noise.box_edge_sigma = 0.02;
  const Sequence sequence = SyntheticSequence(scene, true);
  const PlanesEstimate here = Estimate(sequence);
  const Rigid3d motion = RandomRigid();
  const PlanesEstimate there = Estimate(TransformSequence(motion, sequence));
  ASSERT_EQ(here.planes.size(), 1u);
  ASSERT_EQ(there.planes.size(), 1u);
  const Plane expected = Transform(motion, here.planes[0].plane_in_world);
  EXPECT_LT((there.planes[0].plane_in_world.normal - expected.normal).norm(), 1e-4);
  EXPECT_NEAR(expected.SignedDistance(there.planes[0].point_in_world), 0.0, 1e-4);
}

// The normalised error squared of the plane's three degrees of freedom has mean 3 where the
// covariance is honest; 99 % of the means of 12 lie in 1.5 to 5.1.
TEST(SlowEstimatePlanes, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int kScenes = 12;
  double sum = 0.0;
  for (int seed = 0; seed < kScenes; ++seed) {
    Scene scene = CuboidScene(100 + seed, 3);
    scene.noise.box_edge_sigma = 0.02;
    const Sequence sequence = SyntheticSequence(scene, true);
    PlanesOptions options = ModelOptions();
    options.new_plane_cost = 1e3;  // one floor
    const PlanesEstimate estimate = Estimate(sequence, options);
    ASSERT_EQ(estimate.planes.size(), 1u) << seed;
    sum += NormalisedErrorSquared(sequence, estimate);
  }
  EXPECT_GT(sum / kScenes, 1.5);
  EXPECT_LT(sum / kScenes, 5.1);
}

// Ground of points: up and the true planes, `offset` too high.
PointGround GroundOf(const Sequence& sequence, double offset, double sigma_m) {
  PointGround ground;
  ground.up_in_world = sequence.planes[0].plane_in_world.normal;
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(ground.up_in_world);
  ground.up_information = 1e10 * d_turns * d_turns.transpose();
  for (const SupportPlane& plane : sequence.planes) {
    const Plane& truth = plane.plane_in_world;
    ground.planes.push_back({(offset - truth.offset) * truth.normal, sigma_m});
  }
  return ground;
}

TEST(EstimatePlanes, PlanesOfPointsAreWeighedWithBoxes) {
  Sequence sequence = SyntheticSequence(WithShelf(CuboidScene(1, 4), 0.25), true);
  const auto offset_by = [&](double sigma_m) {
    sequence.ground = GroundOf(sequence, 0.02, sigma_m);
    const PlanesEstimate estimate = Estimate(sequence);
    EXPECT_EQ(estimate.planes.size(), 2u);
    ExpectInTurn(estimate);
    EXPECT_TRUE(estimate.planes[0].height_prior && estimate.planes[1].height_prior);
    return CompareWithGiven(sequence, estimate, 0)->offset;
  };
  EXPECT_NEAR(offset_by(1e-5), 0.02, 1e-3);
  EXPECT_NEAR(offset_by(1.0), 0.0, 0.005);
}

TEST(EstimatePlanes, BoxesHavePlanesWherePointsHaveNone) {
  Sequence sequence = SyntheticSequence(WithShelf(CuboidScene(1, 4), 0.25), false);
  sequence.ground = GroundOf(sequence, 0.0, 0.001);
  sequence.ground->planes.pop_back();  // the shelf's
  sequence.ground->planes.push_back(
      {sequence.ground->planes[0].point_in_world + 1.5 * sequence.ground->up_in_world, 0.001});
  const PlanesEstimate estimate = Estimate(sequence);
  ASSERT_EQ(estimate.planes.size(), 2u) << "the bare one is left out";
  EXPECT_TRUE(estimate.planes[0].height_prior);
  EXPECT_FALSE(estimate.planes[1].height_prior);
  ExpectInTurn(estimate);
}

TEST(EstimatePlanes, OfTwoPlanesOfPointsOnOneLevelTheSurerIsItsPrior) {
  Sequence sequence = SyntheticSequence(CuboidScene(1, 4), true);
  sequence.ground = GroundOf(sequence, 0.0, 0.02);
  const HeightPrior& table = sequence.ground->planes[0];
  sequence.ground->planes.push_back(
      {table.point_in_world + 0.005 * sequence.ground->up_in_world, 0.01});
  const PlanesEstimate estimate = Estimate(sequence);
  ASSERT_EQ(estimate.planes.size(), 1u);
  EXPECT_EQ(estimate.planes[0].height_prior->sigma_m, 0.01);
}

TEST(EstimatePlanes, WhatHangsHasNoFloorOfPoints) {
  Sequence sequence = SyntheticSequence(CuboidScene(1, 4), false);
  auto priors = TrueCuboidPriors(sequence, kLogSigma);
  for (auto& prior : priors) prior->mount = Mount::kHanging;
  const auto planes = [&] {
    const auto found = FindPlanes(sequence, priors, CamerasUp(sequence), ModelOptions(), 2);
    return found ? found->planes.size() : 0;
  };
  const size_t without = planes();
  sequence.ground = GroundOf(sequence, 0.0, 0.01);
  EXPECT_EQ(planes(), without);
}

TEST(EstimatePlanes, PlanesOfPointsHoldObjectsThatAreSeenOnce) {
  Sequence sequence = SyntheticSequence(CuboidScene(2, 3), false);
  for (int i = 0; i < 3; ++i) KeepOneDetectionOf(i, &sequence);
  const auto priors = TrueCuboidPriors(sequence, kLogSigma);
  EXPECT_FALSE(FindPlanes(sequence, priors, CamerasUp(sequence), ModelOptions(), 2));
  sequence.ground = GroundOf(sequence, 0.0, 0.001);
  const PlanesEstimate estimate = Estimate(sequence);
  ASSERT_EQ(estimate.planes.size(), 1u);
  EXPECT_EQ(estimate.objects[0].reason, SupportReason::kLowestCost);
}

TEST(HeightPriorTest, ItsEvidenceIsItsCostInMovedPlanes) {
  for (int i = 0; i < 20; ++i) {
    const HeightPrior prior = {RandomVector(-2, 2), 0.1};
    const Plane plane = RandomPlane();
    const Eigen::Vector3d pivot = RandomVector(-1, 1);
    const PlaneEvidence evidence = ComputePlaneEvidence(prior, plane, pivot);
    const PlaneMotion motion = 1e-5 * RandomVector(-1, 1);
    const double at_moved =
        ComputePlaneEvidence(prior, ApplyMotion(plane, pivot, motion), pivot).cost;
    EXPECT_NEAR(at_moved - evidence.cost,
                evidence.gradient.dot(motion) + 0.5 * motion.dot(evidence.information * motion),
                1e-6 * (1.0 + evidence.cost));
  }
}

TEST(EstimatePlanes, AnObjectWithoutBoxesStandsWhereMostDo) {
  Sequence sequence = SyntheticSequence(WithShelf(CuboidScene(2, 4), 0.3), false);
  std::erase_if(sequence.detections,
                [](const Detection& detection) { return detection.object_index == 1; });
  const PlanesEstimate estimate = Estimate(sequence);
  ASSERT_EQ(estimate.planes.size(), 2u);
  EXPECT_EQ(estimate.objects[1].reason, SupportReason::kNoViews);
  EXPECT_EQ(estimate.objects[1].plane_index, 0);
}

// What moves takes part in nothing.
TEST(EstimatePlanes, AMovingObjectDoesNotDecide) {
  const Sequence sequence = SyntheticSequence(CuboidScene(3, 4), false);
  PlanesOptions options = ModelOptions();
  Sequence moving = sequence;
  moving.objects[1].is_static = false;
  const PlanesEstimate with = Estimate(moving, options);
  EXPECT_EQ(with.objects[1].reason, SupportReason::kMoving);
  for (Detection& detection : moving.detections) {
    if (detection.object_index == 1) detection.box.y_max += 40.0;
  }
  const PlanesEstimate again = Estimate(moving, options);
  EXPECT_EQ(with.planes[0].plane_in_world.normal, again.planes[0].plane_in_world.normal);
  EXPECT_EQ(with.planes[0].plane_in_world.offset, again.planes[0].plane_in_world.offset);
}

}  // namespace
}  // namespace soslam
