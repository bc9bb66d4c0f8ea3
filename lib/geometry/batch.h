// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace soslam {

// Numbers that loops take together: many enough for the processor to work on several at once, few
// enough to stay in its nearest cache.
inline constexpr int kBatchSize = 32;
using Batch = Eigen::Array<double, kBatchSize, 1>;
using BatchOfPixels = std::array<Batch, 2>;
using BatchOfVectors = std::array<Batch, 3>;

}  // namespace soslam
