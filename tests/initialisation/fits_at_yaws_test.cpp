// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fits_at_yaws.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "initialisation/box_fit.h"
#include "initialisation/closed_form.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;

struct Start {
  Eigen::Array4d depths_m;
  UprightVector parameters;
};

std::vector<Start> StartsAround(const UprightObservation& observation) {
  const BoxFit fit(observation);
  const ClosedForm closed_form(observation);
  std::vector<Start> starts;
  for (int i = 0; i < 20 && starts.size() < FitsAtYaws::kYaws; ++i) {
    const auto start = closed_form.At(RandomYaw());
    if (start) starts.push_back({fit.TangentDepths(*start), *start});
  }
  return starts;
}

TEST(FitsAtYaws, EndWhereBoxAndRatiosHaveTheirMinimum) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(p);
      UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
      observation.prior.log_correlation = RandomUniform(-0.9, 0.9);
      observation.axes_weight = 0.0;
      const auto starts = StartsAround(observation);
      if (starts.size() < FitsAtYaws::kYaws) continue;
      const BoxFit fit(observation);
      const BoxOnGround box(observation.edges, Rigid3d(), fit.ground());
      const RatioRows ratio(observation.prior);
      FitsAtYaws fits(box, ratio, p);
      for (size_t k = 0; k < starts.size(); ++k) {
        fits.Start(k, starts[k].depths_m, starts[k].parameters);
      }
      fits.Minimise(kMaxIterations);
      for (size_t k = 0; k < starts.size(); ++k) {
        ++checked;
        const UprightVector found = fits.Parameters(k);
        EXPECT_EQ(found[0], starts[k].parameters[0]);
        const QuadraticModel<6> model = fit.Evaluate(starts[k].depths_m, found);
        EXPECT_NEAR(fits.Cost(k), model.cost, 1e-9 * (1.0 + model.cost));
        // What one more step of Gauss and Newton would bring.
        const auto information = model.information.bottomRightCorner<5, 5>();
        const auto gradient = model.gradient.tail<5>();
        EXPECT_LT(0.5 * gradient.dot(information.ldlt().solve(gradient)),
                  1e-6 * (1.0 + model.cost));
      }
    }
  }
  EXPECT_GT(checked, 150);
}

TEST(FitsAtYaws, DoNotDependOnTheirPlaceNorOnTheOthers) {
  for (const double p : kShapeExponents) {
    const StandingBody body(p);
    const UprightObservation observation = body.Observe(Disturbed(body.box, 0.02));
    const auto starts = StartsAround(observation);
    ASSERT_EQ(starts.size(), FitsAtYaws::kYaws);
    const BoxOnGround box(observation.edges, Rigid3d(), UprightGround(body.plane));
    const RatioRows ratio(observation.prior);
    const auto fitted = [&](const std::array<size_t, FitsAtYaws::kYaws>& order) {
      FitsAtYaws fits(box, ratio, p);
      for (size_t place = 0; place < order.size(); ++place) {
        fits.Start(place, starts[order[place]].depths_m, starts[order[place]].parameters);
      }
      fits.Minimise(kMaxIterations);
      return fits;
    };
    const FitsAtYaws one = fitted({0, 1, 2, 3});
    const FitsAtYaws other = fitted({3, 0, 0, 1});
    EXPECT_EQ(one.Cost(0), other.Cost(2));
    EXPECT_EQ(one.Cost(1), other.Cost(3));
    EXPECT_EQ(one.Parameters(3), other.Parameters(0));
  }
}

TEST(FitsAtYaws, OfEdgesThatDoNotTellTheFootHaveNoCost) {
  const StandingBody body(2.0);
  const UprightObservation observation = body.Observe(body.box);
  const auto starts = StartsAround(observation);
  ASSERT_FALSE(starts.empty());
  const RatioRows ratio(observation.prior);
  BoxOnGround box(observation.edges, Rigid3d(), UprightGround(body.plane));
  const auto have_a_cost = [&] {
    FitsAtYaws fits(box, ratio, 2.0);
    for (size_t place = 0; place < FitsAtYaws::kYaws; ++place) {
      fits.Start(place, starts.front().depths_m, starts.front().parameters);
    }
    fits.Minimise(kMaxIterations);
    return std::isfinite(fits.Cost(0));
  };
  EXPECT_TRUE(have_a_cost());
  box.normals.col(1) = 2.0 * box.normals.col(0);
  EXPECT_FALSE(have_a_cost());
  box.normals.col(0) *= 1e-9;
  EXPECT_FALSE(have_a_cost());
  box.normals.col(0).setZero();
  EXPECT_FALSE(have_a_cost());
}

}  // namespace
}  // namespace soslam
