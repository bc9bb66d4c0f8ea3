// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/fit_object.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr double kStep = 3.0 * kRadPerDeg;
constexpr size_t kAll = 1000;

std::vector<ObjectFit> Optima(const ObjectEvidence& evidence, size_t max_count = kAll) {
  return FitObject(evidence, kStep, max_count);
}

// Yaws that all explain a box and are a few steps of the grid apart may be found as one, with next
// to no cost between them.
TEST(FitObject, HaveTheTrueBodyAmongThem) {
  int bodies = 0;
  int found = 0;
  int found_nearby = 0;
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const ObservedBody body(p);
      const auto optima = Optima(body.evidence);
      ASSERT_FALSE(optima.empty());
      EXPECT_LT(optima.front().cost.total, 1e-3) << "body " << i << ", p " << p;
      bool is_found = false;
      double nearest = std::numbers::pi;
      for (const ObjectFit& optimum : optima) {
        if (optimum.cost.total > 0.02) continue;  // a tenth of a standard deviation of each edge
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

ObjectEvidence NoisyEvidence(double axes_weight) {
  const ObservedBody body(RandomUniform(1, 2));
  ObjectEvidence evidence = body.Observe(Disturbed(body.box, 0.03));
  evidence.axes_weight = axes_weight;
  return evidence;
}

Landmark RandomStart(const ObjectEvidence& evidence) {
  std::optional<Landmark> solution;
  while (!solution) solution = SolveAtYaw(evidence, RandomYaw());
  const Landmark& at_yaw = *solution;
  UprightVector parameters = UprightParametrisation(evidence.plane).ComputeParameters(at_yaw);
  parameters.segment<2>(1) += 0.5 * at_yaw.half_axes.maxCoeff() * RandomVector(-1, 1).head<2>();
  parameters.segment<3>(3) += RandomVector(-0.3, 0.3);
  return UprightParametrisation(evidence.plane).LandmarkAt(parameters, at_yaw.shape_exponents);
}

TEST(FitObject, NoneOfManyRandomStartsIsBetter) {
  for (const double axes_weight : {0.0, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      const ObjectEvidence evidence = NoisyEvidence(axes_weight);
      const auto optima = Optima(evidence);
      ASSERT_FALSE(optima.empty());
      double lowest = std::numeric_limits<double>::infinity();
      for (int start = 0; start < 100; ++start) {
        std::optional<UprightSolution> solution = UprightSolution{RandomStart(evidence), 0.0};
        // Until the tangent points' depths are those of the solution.
        for (int round = 0; round < 5 && solution; ++round) {
          const Landmark& landmark = solution->landmark;
          solution = FitUpright(evidence.plane, landmark, CostsAt(evidence, landmark));
          if (solution && !IsInFront(solution->landmark)) solution.reset();
        }
        if (solution) {
          lowest = std::min(lowest, EvaluateCost(evidence, solution->landmark).total);
        }
      }
      const double found = EvaluateCost(evidence, optima.front().landmark).total;
      EXPECT_LE(found, lowest + 0.01 + 0.02 * lowest) << "body " << i << ", " << axes_weight;
    }
  }
}

// What is left out costs about as much as the tolerance says; one larger than all costs leaves out
// everything.
TEST(FitObject, EndsWithinItsTolerance) {
  double sum_of_exact = 0.0, sum_of_coarse = 0.0;
  for (int i = 0; i < 20; ++i) {
    ObjectEvidence evidence = NoisyEvidence(0.0);
    const double exact = Optima(evidence, 1).front().cost.total;
    evidence.tolerance = {.cost = 1e-5, .half_axes = 1e-3};
    const double loose = Optima(evidence, 1).front().cost.total;
    EXPECT_NEAR(loose, exact, 1e-2 * (1.0 + exact));
    evidence.tolerance = {.cost = 1e9, .half_axes = 1e9};
    sum_of_exact += exact;
    sum_of_coarse += Optima(evidence, 1).front().cost.total;
  }
  EXPECT_GT(sum_of_coarse, 1.1 * sum_of_exact);
}

TEST(FitObject, AreSortedDistinctLandmarksInFrontOfTheCamera) {
  for (int i = 0; i < 50; ++i) {
    const ObjectEvidence evidence = NoisyEvidence(i % 2);
    const auto optima = Optima(evidence);
    ASSERT_FALSE(optima.empty());
    for (size_t one = 0; one < optima.size(); ++one) {
      EXPECT_TRUE(IsInFront(optima[one].landmark));
      const double before = optima[one == 0 ? 0 : one - 1].cost.total;
      EXPECT_LE(before, optima[one].cost.total + 1e-7 * (1.0 + before));  // single precision
      for (size_t other = 0; other < one; ++other) {
        EXPECT_GT(AngleBetweenFronts(optima[one].landmark, optima[other].landmark),
                  0.5 * kRadPerDeg);
      }
    }
  }
}

TEST(FitObject, FewAreTheBestOfAll) {
  for (int i = 0; i < 200; ++i) {
    const ObjectEvidence evidence = NoisyEvidence(i % 2);
    const auto all = Optima(evidence);
    for (const size_t count : {1u, 2u}) {
      const auto few = Optima(evidence, count);
      ASSERT_EQ(few.size(), std::min<size_t>(count, all.size()));
      for (size_t k = 0; k < few.size(); ++k) {
        EXPECT_NEAR(few[k].cost.total, all[k].cost.total, 1e-3)
            << "body " << i << ": " << k << " of " << count;
      }
    }
  }
}

// A cost on top that only one yaw is spared, between the points of the grid.
TEST(FitObject, FollowTheExtraCostToATenthOfTheGridsStep) {
  for (int i = 0; i < 20; ++i) {
    ObservedBody body(RandomUniform(1, 2), /*ratio_log_sigma=*/0.5);
    const double yaw = RandomYaw();
    body.evidence.compared_cost = [&](const Landmark& landmark, double /*limit*/) {
      const double turn = Yaw(body.plane.normal, landmark.frame_from_object.rotation) - yaw;
      return 1e4 * std::pow(std::sin(turn), 2);
    };
    const auto optima = Optima(body.evidence);
    ASSERT_FALSE(optima.empty());
    const Landmark& best = optima.front().landmark;
    EXPECT_LT(std::abs(YawDifferenceModuloPi(
                  Yaw(body.plane.normal, best.frame_from_object.rotation), yaw)),
              0.1 * kStep);
    EXPECT_GE(optima.front().cost.total, optima.front().cost.compared);
    EXPECT_EQ(optima.front().cost.compared, body.evidence.compared_cost(best, 0.0));
  }
}

}  // namespace
}  // namespace soslam
