// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fit_four_yaws.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <optional>

#include "initialisation/box_fit.h"
#include "initialisation/closed_form.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;
using Starts = std::array<StartAtYaw, 4>;

// From the closed form at random yaws.
std::optional<Starts> RandomStarts(const UprightObservation& observation) {
  const ClosedForm closed_form(observation);
  Starts starts;
  size_t next = 0;
  for (int i = 0; i < 20 && next < starts.size(); ++i) {
    const auto start = closed_form.At(RandomYaw());
    if (start) starts[next++] = *start;
  }
  return next == starts.size() ? std::optional(starts) : std::nullopt;
}

struct RandomBox {
  explicit RandomBox(double p) : body(p), observation(body.Observe(Disturbed(body.box, 0.05))) {
    observation.prior.log_correlation = RandomUniform(-0.9, 0.9);
    observation.axes_weight = 0.0;
  }
  BoxOnGround OnGround() const {
    return BoxOnGround(observation.edges, Rigid3d(), UprightGround(body.plane));
  }
  std::array<FitAtYaw, 4> Fit(const Starts& starts, int max_iterations = kMaxIterations) const {
    return FitFourYaws(OnGround(), RatioRows(observation.prior), observation.prior.shape_exponent,
                       max_iterations, starts);
  }

  StandingBody body;
  UprightObservation observation;
};

TEST(FitFourYaws, EndWhereBoxAndRatiosHaveTheirMinimum) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    // Near kinks, steps of Gauss and Newton go to and fro and have to be damped.
    const double tolerance = p == kEllipsoidExponent ? 1e-10 : 1e-6;
    for (int i = 0; i < 20; ++i) {
      const RandomBox box(p);
      const auto starts = RandomStarts(box.observation);
      if (!starts) continue;
      const BoxFit fit(box.observation);
      const auto fits = box.Fit(*starts);
      for (size_t k = 0; k < fits.size(); ++k) {
        ++checked;
        EXPECT_EQ(fits[k].parameters[0], (*starts)[k].parameters[0]);
        const QuadraticModel<6> model = fit.Evaluate((*starts)[k].depths_m, fits[k].parameters);
        EXPECT_NEAR(fits[k].cost, model.cost, 1e-9 * (1.0 + model.cost));
        const auto information = model.information.bottomRightCorner<5, 5>();
        const auto gradient = model.gradient.tail<5>();
        const double decrease_of_a_step = 0.5 * gradient.dot(information.ldlt().solve(gradient));
        EXPECT_LT(decrease_of_a_step, tolerance * (1.0 + model.cost));
      }
    }
  }
  EXPECT_GT(checked, 150);
}

// A step of Gauss and Newton with the foot among the unknowns is one without it, where it is at its
// best before.
TEST(FitFourYaws, StepAsWithTheFootAmongTheUnknowns) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 10; ++i) {
      const RandomBox box(p);
      const auto starts = RandomStarts(box.observation);
      if (!starts) continue;
      const BoxFit fit(box.observation);
      const auto before = box.Fit(*starts, /*max_iterations=*/0);
      const auto after = box.Fit(*starts, /*max_iterations=*/1);
      for (size_t k = 0; k < after.size(); ++k) {
        if (!(after[k].cost < before[k].cost)) continue;
        ++checked;
        EXPECT_EQ(before[k].parameters.tail<3>(), (*starts)[k].parameters.tail<3>());
        const QuadraticModel<6> model = fit.Evaluate((*starts)[k].depths_m, before[k].parameters);
        EXPECT_LT(model.gradient.segment<2>(1).norm(), 1e-9 * model.information.norm());
        Eigen::Matrix<double, 5, 5> information = model.information.bottomRightCorner<5, 5>();
        const Eigen::Matrix<double, 3, 2> mixed = information.bottomLeftCorner<3, 2>();
        Eigen::Matrix3d of_axes =
            information.bottomRightCorner<3, 3>() -
            mixed * information.topLeftCorner<2, 2>().inverse() * mixed.transpose();
        of_axes.diagonal() *= 1.0 + 1e-4;  // the first damping
        const Eigen::Vector3d step = -of_axes.ldlt().solve(model.gradient.tail<3>());
        const Eigen::Vector3d stepped = (after[k].parameters - before[k].parameters).tail<3>();
        EXPECT_LT((stepped - step).norm(), 1e-6 * (1e-3 + step.norm()));
      }
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(FitFourYaws, DoNotDependOnTheirPlaceNorOnTheOthers) {
  for (const double p : kShapeExponents) {
    const RandomBox box(p);
    const auto starts = RandomStarts(box.observation);
    ASSERT_TRUE(starts);
    const auto fits = box.Fit(*starts);
    Starts others = {(*starts)[3], (*starts)[0], (*starts)[0], (*starts)[1]};
    others[1].depths_m.setConstant(std::nan(""));
    const auto others_fits = box.Fit(others);
    EXPECT_EQ(fits[3].cost, others_fits[0].cost);
    EXPECT_EQ(fits[3].parameters, others_fits[0].parameters);
    EXPECT_FALSE(std::isfinite(others_fits[1].cost));
    EXPECT_EQ(fits[0].parameters, others_fits[2].parameters);
    EXPECT_EQ(fits[1].parameters, others_fits[3].parameters);
  }
}

TEST(FitFourYaws, LeaveAStartWithoutACostAsItIs) {
  for (const double p : kShapeExponents) {
    const RandomBox box(p);
    auto starts = RandomStarts(box.observation);
    ASSERT_TRUE(starts);
    starts->front().parameters[3] = 1e3;  // of a half axis beyond numbers
    const auto fits = box.Fit(*starts);
    EXPECT_TRUE(std::isnan(fits[0].cost));
    EXPECT_EQ(fits[0].parameters, starts->front().parameters);
    EXPECT_TRUE(std::isfinite(fits[1].cost));
  }
}

TEST(FitFourYaws, OfEdgesThatDoNotTellTheFootHaveNoCost) {
  const StandingBody body(2.0);
  const UprightObservation observation = body.Observe(body.box);
  const auto starts = RandomStarts(observation);
  ASSERT_TRUE(starts);
  BoxOnGround box(observation.edges, Rigid3d(), UprightGround(body.plane));
  const auto has_cost = [&] {
    const auto fits = FitFourYaws(box, RatioRows(observation.prior), 2.0, kMaxIterations, *starts);
    return std::isfinite(fits.front().cost);
  };
  EXPECT_TRUE(has_cost());
  box.normals.col(1) = 2.0 * box.normals.col(0);
  EXPECT_FALSE(has_cost());
  box.normals.col(0) *= 1e-9;
  EXPECT_FALSE(has_cost());
  box.normals.col(0).setZero();
  EXPECT_FALSE(has_cost());
}

}  // namespace
}  // namespace soslam
