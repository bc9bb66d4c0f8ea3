// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// Weights of observations whose errors are correlated when their directions (of any length) are
// near each other: one over the sum of exp(-(angle / correlation)^2 / 2) over all directions, the
// own one included. Directions closer than about `correlation_rad` together count as one. All
// weights are 1 where it is zero.
std::vector<double> DirectionWeights(const std::vector<Eigen::Vector3d>& directions,
                                     double correlation_rad);

// Weights of an object's detections, which index Sequence::detections. The misfit between the
// label's shape and a box is almost the same in the next frame: views from directions (camera
// centre to object centre) closer than about `correlation_rad` share it, and together count as one;
// see DirectionWeights.
std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad);

}  // namespace soslam
