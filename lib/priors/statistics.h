// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace soslam {

// Of at least one value; of an even number, the mean of the middle two.
double Median(std::vector<double> values);

// 1.4826 times the median absolute deviation from the median: the standard deviation of normal
// values, whatever less than half of them are (Rousseeuw and Croux 1993). 0 for a single value.
double RobustSigma(const std::vector<double>& values);

// A normal quantity whose mean and spread are both learned: the mean is worth `mean_weight` values,
// the spread `sigma_weight`.
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

// The standard deviation of a value that is still to come: the belief's own, and what its mean may
// be off by. (The scale of the predictive Student distribution.)
double PredictiveSigma(const NormalBelief& belief);

// The correlation of pairs, each coordinate in robust sigmas from its median, at most 2.5. None for
// fewer than three pairs and where a coordinate does not vary.
std::optional<double> RobustCorrelation(const std::vector<std::pair<double, double>>& pairs);

}  // namespace soslam
