// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace soslam {

// Weights of observations whose errors are correlated when their directions (of any length) are
// near each other: one over the sum of exp(-(angle / correlation)^2 / 2) over all directions, the
// own one included. Directions closer than about `correlation_rad` together count as one: the
// misfit between a label's shape and a box is almost the same in the next frame. All weights are 1
// where it is zero.
std::vector<double> DirectionWeights(const std::vector<Eigen::Vector3d>& directions,
                                     double correlation_rad);

}  // namespace soslam
