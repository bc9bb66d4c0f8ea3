// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "soslam/priors/learn_priors.h"

namespace soslam {
namespace {

// 1 / (0.75 quantile of the standard normal distribution).
constexpr double kSigmaByMad = 1.4826;
// Values are clipped at this distance from the median (in robust sigmas).
constexpr double kFarthest = 2.5;

std::vector<double> Standardised(const std::vector<double>& values, double sigma) {
  return CollectValues(values, [sigma, median = MedianOf(values).value()](double value) {
    return std::clamp((value - median) / sigma, -kFarthest, kFarthest);
  });
}

}  // namespace

double RobustSigma(const std::vector<double>& values) {
  const double median = MedianOf(values).value();
  const auto deviation = [&](double value) { return std::abs(value - median); };
  return kSigmaByMad * MedianOf(CollectValues(values, deviation)).value();
}

NormalBelief Update(const NormalBelief& prior, const std::vector<double>& values,
                    double min_sigma) {
  if (values.empty()) return prior;
  const auto n = static_cast<double>(values.size());
  const double median = MedianOf(values).value();
  const double sigma = std::max(min_sigma, RobustSigma(values));
  const double shift = median - prior.mean;
  NormalBelief belief;
  belief.mean_weight = prior.mean_weight + n;
  belief.mean = prior.mean + n / belief.mean_weight * shift;
  belief.sigma_weight = prior.sigma_weight + n;
  const double squares = prior.sigma_weight * prior.sigma * prior.sigma +
                         (n - 1.0) * sigma * sigma +
                         prior.mean_weight * n / belief.mean_weight * shift * shift;
  // Without a prior mean, one degree of freedom is used for the mean.
  if (prior.mean_weight == 0.0) belief.sigma_weight -= 1.0;
  belief.sigma = std::sqrt(squares / belief.sigma_weight);
  return belief;
}

double PredictiveSigma(const NormalBelief& belief) {
  return belief.sigma * std::sqrt(1.0 + 1.0 / belief.mean_weight);
}

std::optional<double> RobustCorrelation(const std::vector<double>& firsts,
                                        const std::vector<double>& seconds) {
  if (firsts.size() < 3) return std::nullopt;
  const double first_sigma = RobustSigma(firsts);
  const double second_sigma = RobustSigma(seconds);
  if (first_sigma <= 0.0 || second_sigma <= 0.0) return std::nullopt;
  const std::vector<double> x = Standardised(firsts, first_sigma);
  const std::vector<double> y = Standardised(seconds, second_sigma);
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  return dot(x, y) / std::sqrt(dot(x, x) * dot(y, y));
}

}  // namespace soslam
