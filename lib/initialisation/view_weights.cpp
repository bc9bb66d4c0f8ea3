// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/view_weights.h"

#include <cmath>

#include "geometry/angles.h"

namespace soslam {

std::vector<double> DirectionWeights(const std::vector<Eigen::Vector3d>& directions,
                                     double correlation_rad) {
  std::vector<double> similar(directions.size(), 1.0);  // sums over all directions
  if (correlation_rad > 0.0) {
    for (size_t i = 0; i < directions.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const double ratio = AngleBetween(directions[i], directions[j]) / correlation_rad;
        const double similarity = std::exp(-0.5 * ratio * ratio);
        similar[i] += similarity;
        similar[j] += similarity;
      }
    }
  }
  std::vector<double> weights;
  for (const double sum : similar) weights.push_back(1.0 / sum);
  return weights;
}

}  // namespace soslam
