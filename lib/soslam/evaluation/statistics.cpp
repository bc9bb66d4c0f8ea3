// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/statistics.h"

#include <algorithm>

namespace soslam {

std::optional<double> MeanOf(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::optional<double> MedianOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double ChiSquareQuantile(int degrees, double normal_quantile) {
  const double spread = 2.0 / (9.0 * degrees);
  return std::pow(1.0 - spread + normal_quantile * std::sqrt(spread), 3);
}

double FisherTail(double ratio, double degrees, double denominator_degrees) {
  const double spread = 2.0 / (9.0 * degrees);
  const double denominator_spread = 2.0 / (9.0 * denominator_degrees);
  const double root = std::cbrt(ratio);
  const double normal = ((1.0 - denominator_spread) * root - (1.0 - spread)) /
                        std::sqrt(denominator_spread * root * root + spread);
  return 0.5 * std::erfc(normal / std::sqrt(2.0));
}

}  // namespace soslam
