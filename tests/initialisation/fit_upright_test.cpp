// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "soslam/initialisation/upright.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

LandmarkCosts BoxAndRatio(const std::array<BoxEdge, 4>& edges, const ShapePrior& prior,
                          const Landmark& start) {
  LandmarkCosts terms;
  terms.push_back(std::make_unique<BoxTerm>(edges, start));
  terms.push_back(std::make_unique<RatioTerm>(prior));
  return terms;
}

Landmark DisturbedFootAndSize(const Landmark& landmark, const Plane& plane) {
  UprightVector parameters = UprightParametrisation(plane).ComputeParameters(landmark);
  parameters.segment<2>(1) += 0.2 * RandomVector(-1, 1).head<2>();
  parameters.segment<3>(3) += RandomVector(-0.2, 0.2);
  return UprightParametrisation(plane).LandmarkAt(parameters, landmark.shape_exponents);
}

// The solver stops where a step would gain less than a millionth of a squared standard deviation.
constexpr double kCostTolerance = 1e-6;

TEST(FitUpright, FindsTheBodyOfAnExactBoxAtItsYaw) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const ObservedBody body(p);
      const Landmark start = DisturbedFootAndSize(body.truth, body.plane);
      const auto terms = BoxAndRatio(body.evidence.views[0].edges, *body.evidence.prior, start);
      const auto solution = FitUpright(body.plane, start, terms, {.yaw = false});
      ASSERT_TRUE(solution);
      EXPECT_LT(solution->cost, kCostTolerance) << p;
      EXPECT_TRUE(IsSameBody(solution->landmark, body.truth, 2e-3)) << p;
    }
  }
}

TEST(FitUpright, LowersTheCostThatItReportsAndKeepsWhatItIsTold) {
  for (int i = 0; i < 100; ++i) {
    const ObservedBody body(RandomUniform(1, 2));
    const auto edges = body.Observe(Disturbed(body.box, 0.05)).views[0].edges;
    const Landmark start =
        RotatedAboutZ(DisturbedFootAndSize(body.truth, body.plane), RandomUniform(-0.5, 0.5));
    const auto terms = BoxAndRatio(edges, *body.evidence.prior, start);
    for (const bool yaw_is_free : {false, true}) {
      const auto solution = FitUpright(body.plane, start, terms, {.yaw = yaw_is_free});
      ASSERT_TRUE(solution);
      const Landmark& landmark = solution->landmark;
      EXPECT_NEAR(solution->cost, TotalCost(terms, landmark), 1e-9 * (1.0 + solution->cost));
      EXPECT_LE(solution->cost, TotalCost(terms, start));
      EXPECT_EQ(landmark.shape_exponents, start.shape_exponents);
      EXPECT_NEAR(body.plane.SignedDistance(landmark.Centre()), landmark.half_axes.z(), 1e-9);
      if (yaw_is_free) continue;
      EXPECT_LT(AngleBetweenFronts(landmark, start), 1e-9);
    }
  }
}

}  // namespace
}  // namespace soslam
