// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/angles.h"
#include "initialisation/upright_observation.h"
#include "initialisation/yaw_sweep.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr double kStep = 3.0 * kRadPerDeg;
constexpr size_t kAll = 1000;

std::vector<UprightSolution> Optima(const UprightObservation& observation, size_t max_count = kAll,
                                    double step = kStep) {
  return LocalOptima(observation, {}, SweepYaw(observation, {}, step), max_count);
}

// Yaws that all explain a box and are a few steps of the grid apart may be found as one, with next
// to no cost between them.
TEST(LocalOptima, HaveTheTrueBodyAmongThem) {
  int bodies = 0;
  int found = 0;
  int found_nearby = 0;
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const ObservedBody body(p);
      const auto optima = Optima(body.observation);
      ASSERT_FALSE(optima.empty());
      EXPECT_LT(optima.front().cost, 1e-3) << "body " << i << ", p " << p;
      bool is_found = false;
      double nearest = std::numbers::pi;
      for (const UprightSolution& optimum : optima) {
        if (optimum.cost > 0.02) continue;  // a tenth of a standard deviation of each edge
        const Landmark& landmark = optimum.landmark;
        is_found = is_found || IsSameBody(landmark, body.truth, 0.02);
        nearest = std::min(nearest, AngleBetweenFronts(landmark, body.truth));
      }
      ++bodies;
      found += is_found ? 1 : 0;
      found_nearby += nearest < 3.0 * kStep ? 1 : 0;
    }
  }
  EXPECT_GE(found, bodies * 9 / 10);
  EXPECT_GE(found_nearby, bodies * 98 / 100);
}

UprightObservation NoisyObservation(double axes_weight) {
  const ObservedBody body(RandomUniform(1, 2));
  UprightObservation observation = body.Observe(Disturbed(body.box, 0.03));
  observation.axes_weight = axes_weight;
  return observation;
}

Landmark RandomStart(const UprightObservation& observation) {
  std::optional<Landmark> solution;
  while (!solution) solution = SolveAtYaw(observation, RandomYaw());
  const Landmark& at_yaw = *solution;
  UprightVector parameters = UprightGround(observation.plane_in_camera).ParametersOf(at_yaw);
  parameters.segment<2>(1) += 0.5 * at_yaw.half_axes.maxCoeff() * RandomVector(-1, 1).head<2>();
  parameters.tail<3>() += RandomVector(-0.3, 0.3);
  return UprightGround(observation.plane_in_camera).LandmarkAt(parameters, at_yaw.shape_exponents);
}

TEST(LocalOptima, NoneOfManyRandomStartsIsBetter) {
  for (const double axes_weight : {0.0, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      const UprightObservation observation = NoisyObservation(axes_weight);
      const auto optima = Optima(observation);
      ASSERT_FALSE(optima.empty());
      double lowest = std::numeric_limits<double>::infinity();
      for (int start = 0; start < 100; ++start) {
        std::optional<UprightSolution> solution = UprightSolution{RandomStart(observation), 0.0};
        // Until the tangent points' depths are those of the solution.
        for (int round = 0; round < 5 && solution; ++round) {
          const Landmark& landmark = solution->landmark;
          solution = FitUpright(observation.plane_in_camera, landmark,
                                ObservationTerms(observation, landmark),
                                /*yaw_is_free=*/true);
          if (solution && !IsInFront(solution->landmark)) solution.reset();
        }
        if (solution) {
          lowest = std::min(lowest, CostAtOwnDepths(observation, solution->landmark));
        }
      }
      const double found = CostAtOwnDepths(observation, optima.front().landmark);
      EXPECT_LE(found, lowest + 0.01 + 0.02 * lowest) << "body " << i << ", " << axes_weight;
    }
  }
}

TEST(LocalOptima, AreSortedDistinctLandmarksInFrontOfTheCamera) {
  for (int i = 0; i < 50; ++i) {
    const UprightObservation observation = NoisyObservation(i % 2);
    const auto optima = Optima(observation);
    ASSERT_FALSE(optima.empty());
    for (size_t one = 0; one < optima.size(); ++one) {
      EXPECT_TRUE(IsInFront(optima[one].landmark));
      const double before = optima[one == 0 ? 0 : one - 1].cost;
      EXPECT_LE(before, optima[one].cost + 1e-7 * (1.0 + before));  // single precision
      for (size_t other = 0; other < one; ++other) {
        EXPECT_GT(AngleBetweenFronts(optima[one].landmark, optima[other].landmark),
                  0.5 * kRadPerDeg);
      }
    }
  }
}

TEST(LocalOptima, FewAreTheBestOfAll) {
  for (int i = 0; i < 200; ++i) {
    const UprightObservation observation = NoisyObservation(i % 2);
    const auto all = Optima(observation);
    for (const size_t count : {1u, 2u}) {
      const auto few = Optima(observation, count);
      ASSERT_EQ(few.size(), std::min<size_t>(count, all.size()));
      for (size_t k = 0; k < few.size(); ++k) {
        EXPECT_NEAR(few[k].cost, all[k].cost, 1e-3) << "body " << i << ": " << k << " of " << count;
      }
    }
  }
}

// A cost on top that only one yaw is spared, between the points of the grid.
TEST(LocalOptima, FollowTheExtraCostToATenthOfTheGridsStep) {
  for (int i = 0; i < 20; ++i) {
    const ObservedBody body(RandomUniform(1, 2), /*ratio_log_sigma=*/0.5);
    const double yaw = RandomYaw();
    YawObjective objective;
    objective.compared_cost = [&](const Landmark& landmark) {
      const double turn = Yaw(body.plane.normal, landmark.frame_from_object.rotation) - yaw;
      return 1e4 * std::pow(std::sin(turn), 2);
    };
    const YawSweep sweep = SweepYaw(body.observation, objective, kStep);
    const auto optima = LocalOptima(body.observation, objective, sweep, kAll);
    ASSERT_FALSE(optima.empty());
    const Landmark& best = optima.front().landmark;
    EXPECT_LT(std::abs(YawDifferenceModuloPi(
                  Yaw(body.plane.normal, best.frame_from_object.rotation), yaw)),
              0.1 * kStep);
    EXPECT_GE(optima.front().cost, objective.compared_cost(best));
  }
}

}  // namespace
}  // namespace soslam
