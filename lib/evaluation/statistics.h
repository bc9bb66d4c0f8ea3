// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace soslam {

// None if there are no values.
std::optional<double> MeanOf(const std::vector<double>& values);
std::optional<double> MedianOf(std::vector<double> values);

// The quantile of the chi-square distribution, divided by its degrees of freedom, that belongs to
// one of the standard normal distribution (Wilson and Hilferty).
double ChiSquareQuantile(int degrees, double normal_quantile);

}  // namespace soslam
