// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/priors/learn_priors.h"

namespace soslam {
namespace {

TEST(RobustSigma, IgnoresAnOutlier) {
  EXPECT_DOUBLE_EQ(RobustSigma({1.0, 2.0, 3.0, 4.0, 100.0}), 1.4826);  // deviations 2 1 0 1 97
  EXPECT_EQ(RobustSigma({5.0}), 0.0);
}

TEST(Update, WithoutValuesNothingIsLearned) {
  const NormalBelief belief = Update({2.0, 1.0, 0.3, 4.0}, {}, 0.1);
  EXPECT_EQ(belief.mean, 2.0);
  EXPECT_EQ(belief.mean_weight, 1.0);
  EXPECT_EQ(belief.sigma, 0.3);
}

TEST(Update, WithoutAPriorMeanTheMedianIsTheMean) {
  // Robust sigma 1.4826: squares 4 * 0.25 + 2 * 2.19810, of 4 + 3 - 1 values.
  const NormalBelief belief = Update({0.0, 0.0, 0.5, 4.0}, {0.0, 1.0, 2.0}, 0.1);
  EXPECT_DOUBLE_EQ(belief.mean, 1.0);
  EXPECT_EQ(belief.mean_weight, 3.0);
  EXPECT_NEAR(belief.sigma, std::sqrt(5.396205 / 6.0), 1e-6);
  EXPECT_NEAR(PredictiveSigma(belief), belief.sigma * std::sqrt(4.0 / 3.0), 1e-12);
}

TEST(Update, AValueFarFromThePriorMovesItAndWidensIt) {
  // Squares 3 * 1, and 1 * 1 / 2 * (4 - 2)^2 of the disagreement; of 3 + 1 values.
  const NormalBelief belief = Update({2.0, 1.0, 1.0, 3.0}, {4.0}, 0.1);
  EXPECT_DOUBLE_EQ(belief.mean, 3.0);
  EXPECT_DOUBLE_EQ(belief.sigma, std::sqrt(5.0 / 4.0));
}

TEST(Update, EqualValuesAreNotTakenForCertainty) {
  const NormalBelief belief = Update({0.0, 0.0, 0.2, 1.0}, {1.0, 1.0, 1.0}, 0.1);
  EXPECT_DOUBLE_EQ(belief.sigma, std::sqrt((0.04 + 2.0 * 0.01) / 3.0));
}

TEST(RobustCorrelation, OfValuesWorkedByHand) {
  EXPECT_NEAR(RobustCorrelation({0, 1, 2}, {1, 3, 5}).value(), 1.0, 1e-12);
  EXPECT_NEAR(RobustCorrelation({0, 1, 2}, {5, 3, 1}).value(), -1.0, 1e-12);
  // Sums of products: 2 and 2 of the squares, 1 of the mixed ones.
  EXPECT_NEAR(RobustCorrelation({-1, 0, 1}, {0, -1, 1}).value(), 0.5, 1e-12);
}

TEST(RobustCorrelation, OneOutlierDoesNotTurnIt) {
  std::vector<double> firsts = {1e6}, seconds = {-1e6};
  for (int i = -20; i <= 20; ++i) {
    firsts.push_back(i);
    seconds.push_back(i);
  }
  EXPECT_GT(RobustCorrelation(firsts, seconds).value(), 0.5);
}

TEST(RobustCorrelation, NeedsThreePairsThatVary) {
  EXPECT_FALSE(RobustCorrelation({0, 1}, {0, 1}));
  EXPECT_FALSE(RobustCorrelation({0, 1, 2}, {3, 3, 3}));
}

}  // namespace
}  // namespace soslam
