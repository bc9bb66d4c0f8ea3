// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/angles.h"
#include "initialisation/closed_form.h"
#include "initialisation/upright_observation.h"
#include "support/landmark_terms.h"
#include "support/level_sequence.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

using testing::IsEmpty;

constexpr double kStep = 3.0 * kRadPerDeg;

TEST(BoxTerms, AddsThePreferenceForTheScenesAxes) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const Landmark landmark = RotatedAboutZ(body.truth, RandomYaw());
    const double without = CostAtOwnDepths(observation, landmark);
    observation.axes_weight = RandomUniform(0.5, 3.0);
    const Eigen::Vector3d front = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d axis = *observation.scene_axis_in_camera;
    const double angle = std::atan2(front.cross(axis).dot(body.plane.normal), front.dot(axis));
    const double with = CostAtOwnDepths(observation, landmark);
    EXPECT_NEAR(with - without, observation.axes_weight * std::pow(std::sin(2.0 * angle), 2),
                1e-8 * (1.0 + without));
    // A quarter turn of the axis is no change.
    observation.scene_axis_in_camera = axis.cross(body.plane.normal).eval();
    EXPECT_NEAR(CostAtOwnDepths(observation, landmark), with, 1e-8 * (1.0 + with));
  }
}

TEST(BoxTerms, CostsNothingAtTheTruth) {
  for (const double p : kShapeExponents) {
    const StandingBody body(p);
    EXPECT_LT(CostAtOwnDepths(body.observation, body.truth), 1e-15);
  }
}

Landmark LandmarkOf(const UprightObservation& observation, const UprightFit& fit) {
  return UprightGround(observation.plane_in_camera)
      .LandmarkAt(fit.parameters, observation.prior.shape_exponent);
}

TEST(SweepYaw, CoversHalfATurnWithLandmarksAtTheirYaws) {
  for (const double step_deg : {1.0, 3.0, 7.0, 45.0}) {
    const StandingBody body(1.5);
    const YawSweep sweep = SweepYaw(body.observation, {}, step_deg * kRadPerDeg);
    ASSERT_EQ(sweep.yaw.size(), static_cast<size_t>(std::lround(180.0 / step_deg)));
    ASSERT_EQ(sweep.fits.size(), sweep.yaw.size());
    const std::vector<double> costs = sweep.Costs();
    const double step = std::numbers::pi / static_cast<double>(sweep.yaw.size());
    for (size_t i = 0; i < sweep.yaw.size(); ++i) {
      EXPECT_NEAR(sweep.yaw[i], step * static_cast<double>(i), 1e-12);
      ASSERT_TRUE(sweep.fits[i]);
      EXPECT_EQ(costs[i], sweep.fits[i]->cost);
      const Landmark landmark = LandmarkOf(body.observation, *sweep.fits[i]);
      const double yaw = Yaw(body.plane.normal, landmark.frame_from_object.rotation);
      EXPECT_NEAR(YawDifferenceModuloPi(yaw, sweep.yaw[i]), 0.0, 1e-9);
      EXPECT_NEAR(body.plane.SignedDistance(landmark.Centre()), landmark.half_axes.z(), 1e-9);
      EXPECT_EQ(landmark.shape_exponent, 1.5);
      EXPECT_TRUE(IsInFront(landmark));
    }
  }
}

TEST(SweepYaw, IsEmptyWhereThePlaneIsNotInView) {
  StandingBody body(1.5);
  body.observation.plane_in_camera.offset = -1.0;
  const YawSweep sweep = SweepYaw(body.observation, {}, kStep);
  for (const double cost : sweep.Costs()) EXPECT_TRUE(std::isnan(cost));
  EXPECT_THAT(LocalOptima(body.observation, {}, sweep, /*max_count=*/1000), IsEmpty());
}

TEST(SweepYaw, RepeatsItsFitsWithNoFurtherCostsAsWell) {
  const StandingBody body(1.5);
  const UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
  YawObjective several;
  several.rounds = 3;
  YawObjective several_of_none = several;
  several_of_none.further_costs = [](const Landmark&) { return LandmarkCosts(); };
  const auto costs = SweepYaw(observation, several, kStep).Costs();
  EXPECT_EQ(costs, SweepYaw(observation, several_of_none, kStep).Costs());
  EXPECT_NE(costs, SweepYaw(observation, {}, kStep).Costs());
}

// Terms of the start, and again those of the result.
TEST(SweepYaw, RepeatsItsFitsFromTheirResults) {
  constexpr double kFitted = 1e-6;  // fits end where a step lowers the cost by less than 1e-11
  const StandingBody body(1.5);
  std::vector<Landmark> starts;
  YawObjective objective;
  objective.further_costs = [&](const Landmark& start) {
    starts.push_back(start);
    return LandmarkCosts();
  };
  objective.rounds = 3;
  objective.extra_cost = [](const Landmark&) { return 7.0; };
  const YawSweep sweep = SweepYaw(body.observation, objective, 45.0 * kRadPerDeg);
  ASSERT_EQ(starts.size(), 16u);  // of each yaw three fits, and the cost of the result
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(IsSameBody(starts[4 * i], *SolveAtYaw(body.observation, sweep.yaw[i]), 1e-12));
    Landmark landmark = starts[4 * i];
    for (size_t round = 0; round < 3; ++round) {
      EXPECT_TRUE(IsSameBody(starts[4 * i + round], landmark, kFitted));
      landmark =
          FitUpright(body.plane, landmark, ObservationTerms(body.observation, landmark), false)
              ->landmark;
    }
    EXPECT_TRUE(IsSameBody(starts[4 * i + 3], landmark, kFitted));
    const Landmark found = LandmarkOf(body.observation, *sweep.fits[i]);
    EXPECT_TRUE(IsSameBody(found, landmark, kFitted));
    EXPECT_NEAR(sweep.fits[i]->cost, CostAtOwnDepths(body.observation, found) + 7.0, 1e-9);
  }
}

TEST(SceneAxisInCamera, IsThatOfTheObjectsPlane) {
  Sequence sequence = LevelSequence({{300, 250, 340, 300}});
  const Detection& detection = sequence.detections.front();
  sequence.frames.front().world_from_camera = RandomRigid();
  EXPECT_FALSE(SceneAxisInCamera(sequence, detection));
  const Eigen::Vector3d axis = RandomDirection();
  sequence.planes.front().scene_axis_in_world = axis;
  const Eigen::Vector3d in_camera = SceneAxisInCamera(sequence, detection).value();
  EXPECT_LT((sequence.frames.front().world_from_camera.rotation * in_camera - axis).norm(), 1e-12);
}

TEST(MakeUprightObservation, IsWhatTheSequenceAndTheOptionsSay) {
  Sequence sequence = LevelSequence({{300, 250, 400, 300}});
  sequence.planes = {{0, {Eigen::Vector3d::UnitZ(), 0.0}}};
  sequence.planes.front().scene_axis_in_world = Eigen::Vector3d::UnitY();
  Detection& detection = sequence.detections.front();
  detection.is_bound = {false, true, false, false};
  UprightOptions options;
  options.detection_sigma_fraction = 0.1;
  options.axes_weight = 2.5;
  const ShapePrior prior{{0.5, 0.7}, {0.1, 0.2}, 1.3};
  const UprightObservation observation =
      MakeUprightObservation(sequence, detection, prior, options);
  EXPECT_EQ(observation.camera.fx, 500.0);
  EXPECT_EQ(observation.plane_in_camera.normal, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(observation.prior.ratio, prior.ratio);
  EXPECT_EQ(observation.prior.log_sigma, prior.log_sigma);
  EXPECT_EQ(observation.prior.shape_exponent, 1.3);
  EXPECT_EQ(observation.axes_weight, 2.5);
  EXPECT_EQ(observation.scene_axis_in_camera, SceneAxisInCamera(sequence, detection));
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(observation.edges[i].is_bound, i == 1);
    EXPECT_DOUBLE_EQ(observation.edges[i].sigma_px, i % 2 == 0 ? 10.0 : 5.0);
  }
}

}  // namespace
}  // namespace soslam
