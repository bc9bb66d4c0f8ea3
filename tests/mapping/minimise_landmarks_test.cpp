// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "constraints/parameters.h"
#include "mapping/minimise.h"
#include "support/curve_term.h"

namespace soslam {
namespace {

// Landmarks, nothing else, each with a cost of its place along the world's x axis.
class LandmarksTest : public testing::Test {
 protected:
  void Add(double x) {
    values_.push_back(ToParameterBlock(Landmark{}));
    values_.back()[4] = x;
  }
  Minimisation MinimiseEach(const CurveOf& curve) {
    std::vector<Variable> variables;
    for (LandmarkBlock& values : values_) {
      variables.push_back({VariableKind::kLandmark, values.data()});
    }
    std::vector<std::unique_ptr<CurveTerm>> curves;
    Terms terms;
    for (size_t i = 0; i < variables.size(); ++i) {
      curves.push_back(
          std::make_unique<CurveTerm>(std::vector<int>{static_cast<int>(i)}, variables[i], curve));
      terms.push_back(curves.back().get());
    }
    return Minimise(terms, {.max_iterations = 100}, &variables);
  }
  double X(size_t landmark) const { return values_[landmark][4]; }

 private:
  std::vector<LandmarkBlock> values_;
};

// Without them, steps are a quarter of the way: some forty of them.
TEST_F(LandmarksTest, SecondDerivativesCountOnceAStepBringsLittle) {
  Add(1.0);
  const Minimisation result = MinimiseEach([](double x) {
    return Curve{1.0 + 0.5 * x * x, x, 4.0, 1.0};
  });
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.costs.size(), 10U);
  EXPECT_NEAR(X(0), 0.0, 1e-4);
}

// They are much too small: a step that counts them leads too far.
TEST_F(LandmarksTest, SecondDerivativesDoNotCountWhileStepsBringMuch) {
  Add(1.0);
  const Minimisation result = MinimiseEach([](double x) {
    return Curve{0.5 * x * x, x, 1.25, 0.3};
  });
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.costs.back(), 1e-15);
  for (size_t i = 1; i + 1 < result.costs.size(); ++i) {
    EXPECT_LT(result.costs[i], 0.1 * result.costs[i - 1]) << i;
  }
}

// Half of the way with each step.
TEST_F(LandmarksTest, GoOnWhileAnyOfThemMoves) {
  for (const double x : {0.0, 1.0, 0.0}) Add(x);
  const Minimisation result = MinimiseEach([](double x) {
    return Curve{1.0 + 0.5 * x * x, x, 2.0, 2.0};
  });
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(X(1), 0.0, 1e-4);
}

// A hundredth of the least gain, of a cost of 100, is 1e-8; of each landmark's share, 1e-10.
TEST_F(LandmarksTest, EachMovesForItsShareOfTheLeastGain) {
  const double worth_it = std::sqrt(2e-9), not_worth_it = std::sqrt(2e-11);
  Add(worth_it);
  Add(not_worth_it);
  for (int i = 2; i < 100; ++i) Add(0.0);
  const Minimisation result = MinimiseEach([](double x) {
    return Curve{1.0 + 0.5 * x * x, x, 1.0, 1.0};
  });
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(X(0), 0.0, 1e-3 * worth_it);
  EXPECT_EQ(X(1), not_worth_it);
}

}  // namespace
}  // namespace soslam
