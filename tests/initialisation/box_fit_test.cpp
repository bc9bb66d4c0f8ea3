// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/box_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "initialisation/closed_form.h"
#include "support/box_terms.h"
#include "support/landmark_terms.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// A body's box with errors, any edge of which may be a bound, and a prior of everything.
UprightObservation RandomObservation(double p, int i) {
  const StandingBody body(p);
  const std::array<bool, 4> is_bound = {i % 5 == 0, i % 5 == 1, i % 5 == 2, i % 5 == 3};
  UprightObservation observation = body.Observe(Disturbed(body.box, 0.05), is_bound);
  observation.prior.log_correlation = RandomUniform(-0.9, 0.9);
  observation.axes_weight = RandomUniform(0.0, 3.0);
  if (i % 2 == 0) observation.yaw_prior = YawPrior{RandomUniform(-1.5, 1.5), 0.3};
  return observation;
}

TEST(BoxFit, SaysWhatTheTermsSay) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 40; ++i) {
      const UprightObservation observation = RandomObservation(p, i);
      const auto start = ClosedForm(observation).At(RandomYaw());
      if (!start) continue;
      ++checked;
      const BoxFit fit(observation);
      EXPECT_TRUE(start->depths_m.isApprox(fit.TangentDepths(start->parameters), 1e-12));
      UprightVector at = start->parameters;
      at.tail<3>() += RandomVector(-0.1, 0.1);
      const auto landmark = [&](const UprightVector& parameters) {
        return fit.ground().LandmarkAt(parameters, p);
      };
      const QuadraticModel<6> expected = UprightModel(
          BoxTerms(observation, landmark(start->parameters)), fit.ground(), landmark(at));
      const QuadraticModel<6> sum = fit.Evaluate(start->depths_m, at);
      EXPECT_NEAR(sum.cost, expected.cost, 1e-9 * (1.0 + expected.cost));
      EXPECT_LT((sum.gradient - expected.gradient).norm(), 1e-9 * (1.0 + expected.gradient.norm()));
      EXPECT_LT((sum.information - expected.information).norm(),
                1e-9 * (1.0 + expected.information.norm()));
    }
  }
  EXPECT_GT(checked, 50);
}

TEST(BoxFit, EndsWhereTheFitOfTheTermsEnds) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    // Where bodies have kinks, rounding decides on which side of one the last step ends.
    const double tolerance = p == kEllipsoidExponent ? 1e-9 : 1e-6;
    for (int i = 0; i < 40; ++i) {
      const UprightObservation observation = RandomObservation(p, i);
      const auto start = ClosedForm(observation).At(RandomYaw());
      if (!start) continue;
      ++checked;
      const BoxFit fit(observation);
      const Landmark landmark = fit.ground().LandmarkAt(start->parameters, p);
      for (const bool yaw_is_free : {false, true}) {
        for (const bool with_height : {false, true}) {
          const LogNormal height_m{2.2 * landmark.half_axes.z(), 0.3};
          LandmarkCosts all = BoxTerms(observation, landmark);
          LandmarkCosts further;
          for (LandmarkCosts* costs : {&all, &further}) {
            if (with_height) costs->push_back(std::make_unique<HeightTerm>(height_m));
          }
          const auto of_terms = FitUpright(observation.plane_in_camera, landmark, all, yaw_is_free);
          UprightVector parameters = start->parameters;
          const double cost = fit.Minimise(further, yaw_is_free, &parameters);
          ASSERT_TRUE(of_terms);
          EXPECT_NEAR(cost, of_terms->cost, tolerance * (1.0 + cost));
        }
      }
    }
  }
  EXPECT_GT(checked, 50);
}

TEST(BoxFit, OfSeveralYawsIsThatOfEachOfThem) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    const double tolerance = p == kEllipsoidExponent ? 1e-9 : 1e-6;  // as above
    for (int i = 0; i < 10; ++i) {
      const UprightObservation observation = RandomObservation(p, i);
      std::vector<StartAtYaw> starts;
      for (int k = 0; k <= i; ++k) {
        if (const auto start = ClosedForm(observation).At(RandomYaw())) starts.push_back(*start);
      }
      const BoxFit fit(observation);
      const std::vector<FitAtYaw> together = fit.MinimiseAtYaws(starts);
      ASSERT_EQ(together.size(), starts.size());
      for (size_t k = 0; k < starts.size(); ++k) {
        ++checked;
        const UprightVector& found = together[k].parameters;
        const double alone = fit.Minimise({}, /*yaw_is_free=*/false, &starts[k].parameters);
        EXPECT_NEAR(together[k].cost, alone, tolerance * (1.0 + alone));
        EXPECT_NEAR(together[k].cost, fit.Evaluate(starts[k].depths_m, found).cost,
                    1e-9 * (1.0 + alone));
        EXPECT_NEAR(together[k].nearest_depth_m, fit.NearestDepth(found),
                    1e-12 * (1.0 + found.segment<2>(1).norm()));
      }
    }
  }
  EXPECT_GT(checked, 100);
}

// Four planes in one: the foot may be anywhere on it.
TEST(BoxFit, OfSeveralYawsIsThatOfEachWhereTheEdgesDoNotTellTheFoot) {
  const StandingBody body(2.0);
  UprightObservation observation = body.Observe(body.box);
  for (BoxEdge& edge : observation.edges) edge.plane = observation.edges.front().plane;
  const BoxFit fit(observation);
  UprightVector at = fit.ground().ParametersOf(body.truth);
  std::vector<StartAtYaw> starts = {fit.StartAt(at)};
  at[0] += 0.5;
  starts.push_back(fit.StartAt(at));
  const std::vector<FitAtYaw> together = fit.MinimiseAtYaws(starts);
  for (size_t k = 0; k < starts.size(); ++k) {
    EXPECT_EQ(together[k].cost, fit.Minimise({}, /*yaw_is_free=*/false, &starts[k].parameters));
    EXPECT_EQ(together[k].parameters, starts[k].parameters);
    EXPECT_EQ(together[k].nearest_depth_m, fit.NearestDepth(starts[k].parameters));
    EXPECT_TRUE(std::isfinite(together[k].cost));
  }
}

TEST(BoxFit, NearestDepthIsThatOfTheBodysNearestPoint) {
  for (const double p : kShapeExponents) {
    const StandingBody body(p);
    const BoxFit fit(body.observation);
    for (int i = 0; i < 20; ++i) {
      const UprightVector at = RandomUprightParameters();
      const Landmark landmark = fit.ground().LandmarkAt(at, p);
      EXPECT_NEAR(fit.NearestDepth(at),
                  FindSupportPoint(landmark, -Eigen::Vector3d::UnitZ()).point.z(),
                  1e-9 * (1.0 + landmark.half_axes.maxCoeff()));
    }
  }
}

}  // namespace
}  // namespace soslam
