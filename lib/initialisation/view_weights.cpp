// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/view_weights.h"

#include <algorithm>
#include <cmath>

namespace soslam {

std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad) {
  std::vector<double> weights(detections.size(), 1.0);
  if (!(correlation_rad > 0.0)) return weights;
  std::vector<Eigen::Vector3d> directions;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    directions.push_back((centre_in_world - frame.world_from_camera.translation).normalized());
  }
  std::vector<double> similar_views(detections.size(), 1.0);
  for (size_t i = 0; i < directions.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const double chord = (directions[i] - directions[k]).norm();
      const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * chord));
      const double similarity = std::exp(-0.5 * std::pow(angle / correlation_rad, 2));
      similar_views[i] += similarity;
      similar_views[k] += similarity;
    }
  }
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = 1.0 / similar_views[i];
  return weights;
}

}  // namespace soslam
