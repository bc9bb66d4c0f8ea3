// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <limits>

#include "soslam/base/quadratic_model.h"

namespace soslam {
namespace {

using Model = QuadraticModel<2>;

std::optional<Eigen::Vector2d> Plus(const Eigen::Vector2d& at, const Eigen::Vector2d& step) {
  return at + step;
}

// Rosenbrock's valley as two residuals, 10 (y - x^2) and 1 - x.
Model Rosenbrock(const Eigen::Vector2d& at) {
  Model model;
  model.Add(10.0 * (at.y() - at.x() * at.x()), {-20.0 * at.x(), 10.0});
  model.Add(1.0 - at.x(), {-1.0, 0.0});
  return model;
}

TEST(MinimiseSquares, FollowsACurvedValleyToItsMinimum) {
  Eigen::Vector2d at(-1.2, 1.0);
  const Model model = MinimiseSquares(Rosenbrock, Plus, {}, &at);
  EXPECT_LT(model.cost, 1e-12);
  EXPECT_LT((at - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-4);
  at = {-1.2, 1.0};
  EXPECT_GT(MinimiseSquares(Rosenbrock, Plus, {.max_iterations = 1}, &at).cost, 1e-3);
}

TEST(MinimiseSquares, LeavesUnknownsWithoutInfluenceAsTheyAre) {
  const auto linearise = [](const Eigen::Vector2d& at) {
    Model model;
    model.Add(at.x() - 3.0, {1.0, 0.0});
    return model;
  };
  Eigen::Vector2d at(0.0, 7.0);
  MinimiseSquares(linearise, Plus, {}, &at);
  EXPECT_NEAR(at.x(), 3.0, 1e-4);
  EXPECT_EQ(at.y(), 7.0);
}

// x in place of x^2 where x < 0.5 has no step: the solver takes shorter ones.
TEST(MinimiseSquares, ShortensStepsThatLeadNowhere) {
  const auto linearise = [](const Eigen::Vector2d& at) {
    Model model;
    model.Add(at.x() * at.x(), {2.0 * at.x(), 0.0});
    return model;
  };
  const auto plus = [](const Eigen::Vector2d& at, const Eigen::Vector2d& step) {
    return at.x() + step.x() < 0.5 ? std::nullopt : Plus(at, step);
  };
  Eigen::Vector2d at(2.0, 0.0);
  const Model model = MinimiseSquares(linearise, plus, {}, &at);
  EXPECT_GE(at.x(), 0.5);
  EXPECT_LT(model.cost, 0.5);
}

TEST(MinimiseSquares, StaysWhereItsCostIsNotDefined) {
  const auto undefined = [](const Eigen::Vector2d& /*at*/) {
    Model model;
    model.cost = std::numeric_limits<double>::quiet_NaN();
    return model;
  };
  Eigen::Vector2d at(1.0, 2.0);
  EXPECT_FALSE(std::isfinite(MinimiseSquares(undefined, Plus, {}, &at).cost));
  EXPECT_EQ(at, Eigen::Vector2d(1.0, 2.0));
}

}  // namespace
}  // namespace soslam
