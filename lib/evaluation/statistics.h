// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <vector>

namespace soslam {

// None if there are no values.
std::optional<double> MeanOf(const std::vector<double>& values);
std::optional<double> MedianOf(std::vector<double> values);

// The quantile of the chi-square distribution, divided by its degrees of freedom, that belongs to
// one of the standard normal distribution (Wilson and Hilferty).
double ChiSquareQuantile(int degrees, double normal_quantile);

// Half the 95 % interval of the normal distribution, in standard deviations.
inline constexpr double kHalfInterval95 = 1.96;

// Half the 95 % interval of a quantity, as a part of it, by the standard deviation of its
// logarithm: the longer of its two sides.
inline double HalfInterval95(double log_sigma) { return std::expm1(kHalfInterval95 * log_sigma); }

}  // namespace soslam
