// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace soslam {

// Colours of an image in a box: square roots of the shares of a histogram over CIELAB, so that the
// scalar product of two is their Bhattacharyya coefficient, times 255 and rounded.
inline constexpr int kLightnessBins = 4;
inline constexpr int kChromaBins = 8;  // of each of a* and b*
using BoxColours = Eigen::Matrix<std::uint8_t, kLightnessBins * kChromaBins * kChromaBins, 1>;

}  // namespace soslam
