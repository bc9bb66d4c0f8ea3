// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape_prior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
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

}  // namespace
}  // namespace soslam
