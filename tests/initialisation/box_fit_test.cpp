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
