// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/statistics.h"

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

}  // namespace soslam
