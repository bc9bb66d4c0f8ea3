// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace soslam {

// 1.4826 times the median absolute deviation from the median: the standard deviation of normal
// values, robust to less than half of outliers (Rousseeuw and Croux 1993). 0 for a single value.
double RobustSigma(const std::vector<double>& values);

// Belief about a normal quantity whose mean and spread are both learned. The weights are in units
// of observed values.
struct NormalBelief {
  double mean = 0.0;
  double mean_weight = 0.0;
  double sigma = 1.0;
  double sigma_weight = 1.0;
};

// The normal-inverse-chi-squared update (Gelman et al., Bayesian Data Analysis, 3rd edition, eq.
// 3.3), with the median and the robust sigma, at least `min_sigma`, in place of mean and standard
// deviation.
NormalBelief Update(const NormalBelief& prior, const std::vector<double>& values, double min_sigma);

// The standard deviation of a future value: the belief's own spread and the uncertainty of its
// mean. (The scale of the predictive Student distribution.)
double PredictiveSigma(const NormalBelief& belief);

// The correlation of pairs; each coordinate is measured in robust sigmas from its median and
// clipped at 2.5. None for fewer than three pairs, or if a coordinate does not vary.
std::optional<double> RobustCorrelation(const std::vector<std::pair<double, double>>& pairs);

}  // namespace soslam
