// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/shape_prior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "support/random.h"

namespace soslam {
namespace {

// Logarithm of the density of the prior at logarithms of the ratios, but for a constant.
double LogDensity(const ShapePrior& prior, const Eigen::Vector2d& log_ratio) {
  const double across = prior.log_correlation * prior.log_sigma.prod();
  Eigen::Matrix2d covariance{{prior.log_sigma.x() * prior.log_sigma.x(), across},
                             {across, prior.log_sigma.y() * prior.log_sigma.y()}};
  const Eigen::Vector2d apart = log_ratio - prior.ratio.array().log().matrix();
  return -0.5 * apart.dot(covariance.inverse() * apart);
}

TEST(TimesRatioLikelihood, IsTheProductOfBothDensities) {
  for (int i = 0; i < 50; ++i) {
    ShapePrior prior;
    prior.ratio = RandomVector(0.3, 3.0).head<2>();
    prior.log_sigma = RandomVector(0.1, 1.0).head<2>();
    prior.log_correlation = RandomUniform(-0.9, 0.9);
    const Eigen::Vector2d mean = RandomVector(-1.0, 1.0).head<2>();
    const Eigen::Vector2d variance = RandomVector(0.01, 1.0).head<2>();
    const ShapePrior product = TimesRatioLikelihood(prior, mean, variance);
    std::vector<double> constants;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d at = RandomVector(-2.0, 2.0).head<2>();
      const double of_likelihood = -0.5 * (at - mean).cwiseAbs2().cwiseQuotient(variance).sum();
      constants.push_back(LogDensity(product, at) - LogDensity(prior, at) - of_likelihood);
      EXPECT_NEAR(constants.back(), constants.front(), 1e-6);
    }
  }
}

// Where all lengths are known the prior's ratios do not matter; the errors of lengths that two
// ratios share correlate them.
TEST(WithKnownSize, AllLengthsAreTheRatios) {
  ShapePrior prior{{1.0, 1.0}, {0.5, 0.5}, 1.1};
  prior.height_m = LogNormal{2.0, 0.3};
  const ShapePrior known = WithKnownSize(prior, {0.3, 0.6, 1.2});
  EXPECT_NEAR(known.ratio.x(), 0.25, 0.25 * 0.001);
  EXPECT_NEAR(known.ratio.y(), 0.5, 0.5 * 0.001);
  EXPECT_NEAR(known.log_sigma.x(), 0.005 * std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(known.log_correlation, 0.5, 0.01);
  EXPECT_NEAR(known.height_m->median, 1.2, 1.2 * 0.001);
  EXPECT_EQ(known.Length()->length_m.median, 1.2);
  EXPECT_EQ(known.Length()->axis, 2);
}

// A width says nothing of ratios; the height that follows from it has the spread of the ratio.
TEST(WithKnownSize, OneLengthLeavesTheRatios) {
  ShapePrior prior{{0.8, 0.5}, {0.3, 0.2}, 1.1, 0.4};
  prior.height_m = LogNormal{2.0, 0.3};
  const ShapePrior known = WithKnownSize(prior, {{}, 0.6, {}});
  EXPECT_TRUE(known.ratio.isApprox(prior.ratio, 1e-9));
  EXPECT_TRUE(known.log_sigma.isApprox(prior.log_sigma, 1e-9));
  EXPECT_NEAR(known.log_correlation, 0.4, 1e-9);
  EXPECT_NEAR(known.height_m->median, 0.6 / 0.5, 1e-9);
  EXPECT_NEAR(known.height_m->log_sigma, std::hypot(0.2, 0.005), 1e-9);
  EXPECT_EQ(known.Length()->axis, 1);
}

// Depth and width fix their quotient, and with the prior's spreads move both ratios.
TEST(WithKnownSize, TwoLengthsFixTheirQuotient) {
  const ShapePrior prior{{1.0, 1.0}, {0.4, 0.4}, 1.1};
  const ShapePrior known = WithKnownSize(prior, {0.8, 0.4, {}});
  EXPECT_NEAR(known.ratio.x() / known.ratio.y(), 2.0, 0.01);
  EXPECT_NEAR(known.ratio.x() * known.ratio.y(), 1.0, 1e-9);
  EXPECT_GT(known.log_correlation, 0.95);
}

TEST(WithKnownSize, NoneIsTheSamePrior) {
  const ShapePrior prior{{0.8, 0.5}, {0.3, 0.2}};
  EXPECT_EQ(WithKnownSize(prior, {}).ratio, prior.ratio);
  EXPECT_FALSE(WithKnownSize(prior, {}).Length());
}

// The depth of a picture on a wall is along z of its object frame, that of a thing on its back too,
// and the height of a thing on its side along y.
TEST(WithKnownSize, LengthsTurnWithTheObject) {
  ShapePrior prior{{0.8, 0.5}, {0.3, 0.2}};
  const ShapePrior deep = WithKnownSize(prior, {0.1, {}, {}});
  EXPECT_EQ(OnFace(deep, RestingFace::kBack).Length()->axis, 2);
  EXPECT_EQ(OnFace(WithKnownSize(prior, {{}, {}, 0.3}), RestingFace::kSide).Length()->axis, 1);
  prior.mount = Mount::kOnWall;
  EXPECT_EQ(TurnedToSupport(WithKnownSize(prior, {0.1, {}, {}})).Length()->axis, 2);
  EXPECT_EQ(TurnedToSupport(WithKnownSize(prior, {{}, {}, 0.3})).Length()->axis, 0);
}

}  // namespace
}  // namespace soslam
