// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace soslam {

// Number of elements that vectorised loops process together: enough to fill SIMD registers, few
// enough for the nearest cache.
inline constexpr int kBatchSize = 32;
using Batch = Eigen::Array<double, kBatchSize, 1>;
using BatchOfVectors = std::array<Batch, 3>;

}  // namespace soslam
