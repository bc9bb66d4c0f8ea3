// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/view_weights.h"

#include "geometry/direction_weights.h"

namespace soslam {

std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad) {
  std::vector<Eigen::Vector3d> directions;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    directions.push_back(centre_in_world -
                         sequence.FrameOf(detection).world_from_camera.translation);
  }
  return DirectionWeights(directions, correlation_rad);
}

}  // namespace soslam
