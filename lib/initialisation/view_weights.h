// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// Weights of an object's detections. The misfit between the label's shape and a box is almost the
// same in the next frame: views from directions (camera centre to object centre) closer than about
// `correlation_rad` share it, and together count as one. The weight of a view is one over the sum
// of exp(-(angle / correlation)^2 / 2) over all views, itself included; 1 for all if the
// correlation is zero. `detections` index Sequence::detections.
std::vector<double> ViewWeights(const Sequence& sequence, const std::vector<int>& detections,
                                const Eigen::Vector3d& centre_in_world, double correlation_rad);

}  // namespace soslam
