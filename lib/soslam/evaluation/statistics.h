// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

namespace soslam {

// One value of each item that has it: `value_of` is a member or function that returns a double or
// std::optional<double>.
template <typename Items, typename ValueOf>
std::vector<double> CollectValues(const Items& items, const ValueOf& value_of) {
  std::vector<double> values;
  for (const auto& item : items) {
    if (const std::optional<double> value = std::invoke(value_of, item)) values.push_back(*value);
  }
  return values;
}

// Empty without values.
std::optional<double> MeanOf(const std::vector<double>& values);
std::optional<double> MedianOf(std::vector<double> values);

// The quantile of the chi-square distribution, divided by its degrees of freedom, that belongs to
// one of the standard normal distribution (Wilson and Hilferty).
double ChiSquareQuantile(int degrees, double normal_quantile);

// The probability that the quotient of two independent chi-square values, each divided by its
// degrees of freedom, exceeds `ratio`: the upper tail of the F distribution (Paulson).
double FisherTail(double ratio, double degrees, double denominator_degrees);

// Half the 95 % interval of the normal distribution, in standard deviations.
inline constexpr double kHalfInterval95 = 1.96;

// Half the 95 % interval of a quantity, as a part of it, by the standard deviation of its
// logarithm: the longer of its two sides.
inline double HalfInterval95(double log_sigma) { return std::expm1(kHalfInterval95 * log_sigma); }

}  // namespace soslam
