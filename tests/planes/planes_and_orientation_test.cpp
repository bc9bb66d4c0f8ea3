// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/planes_and_orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/planes/camera_orientation.h"
#include "soslam/planes/up_prior.h"
#include "support/expect_error.h"
#include "support/scene.h"

namespace soslam {
namespace {

constexpr double kRatioLogSigma = 0.1;

PlanesOptions OptionsForOrientation() {
  PlanesOptions options;
  options.planes = PlaneSource::kEstimated;
  options.upright.view_correlation_deg = 10.0;
  return options;
}

Sequence NoisySequence(int seed, int objects) {
  Scene scene = RandomScene(seed, objects, 20, {Shape::kBox});
  scene.noise.box_edge_sigma = 0.01;
  return SyntheticSequence(scene, true);
}

PlanesAndOrientation EstimateHeld(const Sequence& sequence) {
  return EstimatePlanesAndOrientation(sequence, {}, TrueCuboidPriors(sequence, kRatioLogSigma),
                                      OptionsForOrientation(), 2);
}

void ExpectTheFloor(const Sequence& sequence, const PlanesAndOrientation& held) {
  const auto error = CompareWithGiven(sequence, held.estimate, 0);
  ASSERT_TRUE(error);
  EXPECT_LT(error->angle, 3.0 * kRadPerDeg);
  EXPECT_LT(std::abs(error->offset), 0.05);
}

const TriedOrientation* Tried(const PlanesAndOrientation& held, CameraOrientation orientation) {
  const auto at =
      std::ranges::find(held.estimate.orientations, orientation, &TriedOrientation::orientation);
  return at == held.estimate.orientations.end() ? nullptr : &*at;
}

TEST(SlowEstimatePlanesAndOrientation, FindsUpForEachRoll) {
  for (int seed = 0; seed < 3; ++seed) {
    const Sequence level = NoisySequence(seed, 5);
    for (int quarters = 0; quarters < 4; ++quarters) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << quarters << " quarters");
      const Sequence sequence = Rolled(level, quarters);
      const PlanesAndOrientation held = EstimateHeld(sequence);
      EXPECT_EQ(held.estimate.orientation, kCameraOrientations.at(quarters));
      EXPECT_EQ(held.estimate.orientation_tilt_variance, 0.0);
      ASSERT_EQ(held.estimate.planes.size(), 1u);
      ExpectTheFloor(sequence, held);
    }
  }
}

// What lies on its side costs too much for planes to be looked for.
TEST(EstimatePlanesAndOrientation, SaysWhatWasTried) {
  const PlanesAndOrientation held = EstimateHeld(Rolled(NoisySequence(1, 6), 1));
  const TriedOrientation* best = Tried(held, CameraOrientation::kRolled90);
  ASSERT_TRUE(best);
  EXPECT_EQ(best->cost, 0.0);
  EXPECT_GT(best->probability, 0.99);
  EXPECT_EQ(best->planes, 1);
  const TriedOrientation* level = Tried(held, CameraOrientation::kLevel);
  ASSERT_TRUE(level);
  EXPECT_GT(level->cost, 10.0);
}

// Each camera sees edges that are vertical where `up` is.
std::vector<SegmentView> ViewsWithVerticals(const Sequence& sequence, const Eigen::Vector3d& up) {
  std::vector<SegmentView> views;
  for (const Frame& frame : sequence.frames) {
    SegmentView view{sequence.camera, {}, frame.world_from_camera};
    const Rigid3d camera_from_world = frame.world_from_camera.Inverse();
    for (const Object& object : sequence.objects) {
      const Eigen::Vector3d foot = object.ground_truth->landmark_in_world.Centre();
      const auto begin = sequence.camera.Project(camera_from_world * foot);
      const auto end = sequence.camera.Project(camera_from_world * (foot + 0.3 * up));
      if (begin && end) view.segments.push_back({*begin, *end});
    }
    views.push_back(view);
  }
  return views;
}

PlanesAndOrientation EstimateWithVerticals(const Sequence& sequence, const Eigen::Vector3d& up) {
  return EstimatePlanesAndOrientation(sequence, ViewsWithVerticals(sequence, up),
                                      TrueCuboidPriors(sequence, kRatioLogSigma),
                                      OptionsForOrientation(), 2);
}

// Planes are looked for without them only where bodies are explained better so.
TEST(EstimatePlanesAndOrientation, VerticalsAreNotDoubtedInVain) {
  const Sequence sequence = NoisySequence(2, 5);
  const PlanesAndOrientation held = EstimateWithVerticals(sequence, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(held.estimate.verticals);
  for (const TriedOrientation& tried : held.estimate.orientations) {
    if (tried.orientation != CameraOrientation::kLevel) continue;
    EXPECT_EQ(tried.planes.has_value(), tried.verticals);
  }
}

TEST(EstimatePlanesAndOrientation, VerticalsThatBodiesContradictAreDoubted) {
  const Sequence sequence = NoisySequence(2, 5);
  const Eigen::Vector3d tilted(std::sin(10.0 * kRadPerDeg), 0.0, std::cos(10.0 * kRadPerDeg));
  const PlanesAndOrientation held = EstimateWithVerticals(sequence, tilted);
  EXPECT_FALSE(held.estimate.verticals);
  ExpectTheFloor(sequence, held);
}

TEST(EstimatePlanesAndOrientation, RefusesWhatOneViewCannotTell) {
  Sequence sequence = NoisySequence(1, 3);
  std::erase_if(sequence.detections, [&](const Detection& detection) {
    return detection.frame_index != sequence.detections.front().frame_index;
  });
  ExpectError<NothingUsableError>([&] { EstimateHeld(sequence); }, {"several places"});
}

constexpr double kRightAngle = 0.5 * std::numbers::pi;

OrientationEvidence Evidence(CameraOrientation orientation, const Eigen::Vector3d& up,
                             std::vector<std::optional<double>> object_costs) {
  OrientationEvidence evidence;
  evidence.orientation = orientation;
  evidence.up_in_world = up;
  evidence.object_costs = std::move(object_costs);
  return evidence;
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kSide = Eigen::Vector3d::UnitX();

// A clear choice adds no uncertainty.
TEST(ChooseOrientation, WithoutOtherEvidenceCamerasAreLevel) {
  const auto rolled = Evidence(CameraOrientation::kRolled90, kSide, {1.0});
  const auto level = Evidence(CameraOrientation::kLevel, kUp, {1.0});
  const OrientationChoice choice = ChooseOrientation({rolled, level}, 10.0);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_NEAR(choice.costs[0], std::log(100.0), 1e-12);
  EXPECT_EQ(choice.costs[1], 0.0);
  EXPECT_NEAR(choice.probabilities[0], 1.0 / 101.0, 1e-12);
  EXPECT_EQ(choice.tilt_variance, 0.0);
  EXPECT_GT(ChooseOrientation({rolled, level}, 10.0, 1e-9).tilt_variance, 0.0);
}

// One in eleven: far from clear.
TEST(ChooseOrientation, TheUncertaintyIsThatOfAllThatMayBeRight) {
  const auto level = Evidence(CameraOrientation::kLevel, kUp, {1.0, 1.0});
  const auto rolled = Evidence(CameraOrientation::kRolled90, kSide, {1.0, 1.0 - std::log(1000.0)});
  const OrientationChoice choice = ChooseOrientation({level, rolled}, 10.0);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_NEAR(choice.tilt_variance, kRightAngle * kRightAngle / 11.0, 1e-9);
}

TEST(ChooseOrientation, AnotherWayToTheSameUpIsNoDoubt) {
  const auto level = Evidence(CameraOrientation::kLevel, kUp, {0.0});
  const Eigen::Vector3d near_up = Eigen::Vector3d(0.05, 0.0, 1.0).normalized();
  const auto down = Evidence(CameraOrientation::kLookingDown, near_up, {-4.0});
  const OrientationChoice choice = ChooseOrientation({level, down}, 10.0);
  EXPECT_GT(choice.probabilities[1], 0.3);
  EXPECT_EQ(choice.tilt_variance, 0.0);
}

// Its boxes may be of two things: its cost says no more than that.
TEST(ChooseOrientation, NoObjectAloneDecides) {
  const auto level = Evidence(CameraOrientation::kLevel, kUp, {500.0, 0.0, 0.0});
  const auto rolled = Evidence(CameraOrientation::kRolled90, kSide, {0.0, 8.0, 8.0});
  EXPECT_EQ(ChooseOrientation({level, rolled}, 1e3).best, 0u);
  const auto without_body = Evidence(CameraOrientation::kLevel, kUp, {std::nullopt, 0.0, 0.0});
  EXPECT_EQ(ChooseOrientation({without_body, rolled}, 1e3).costs,
            ChooseOrientation({level, rolled}, 1e3).costs);
}

TEST(ChooseOrientation, ThingsAreSeldomSeenFromBelowTheirPlane) {
  auto level = Evidence(CameraOrientation::kLevel, kUp, {1.0});
  auto hung_upside_down = Evidence(CameraOrientation::kRolled180, -kUp, {1.0});
  level.share_from_below = 1.0;
  EXPECT_EQ(ChooseOrientation({level, hung_upside_down}, 10.0).best, 1u);
  level.share_from_below = 0.3;
  EXPECT_EQ(ChooseOrientation({level, hung_upside_down}, 10.0).best, 0u);
}

TEST(ChooseOrientation, WhatCannotBeChosenMakesDoubt) {
  const auto level = Evidence(CameraOrientation::kLevel, kUp, {1.0, 9.0});
  auto rolled = Evidence(CameraOrientation::kRolled90, kSide, {1.0, 1.0});
  rolled.can_be_chosen = false;
  const OrientationChoice choice = ChooseOrientation({rolled, level}, 1e3);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_LT(choice.costs[0], 0.0);
  EXPECT_GT(choice.tilt_variance, 1.0);
}

}  // namespace
}  // namespace soslam
