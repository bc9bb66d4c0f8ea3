// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "geometry/box.h"

namespace soslam {

// Mean distances by which the edges of a detector's boxes (left, top, right, bottom) lie outside
// the outline of the body, as fractions of the width or height of the box; negative: inside. Those
// of opposite edges have a sum below 1.
using EdgeBias = std::array<double, 4>;

// The box without the bias of its edges. Bounds are not measured and stay.
Box WithoutBias(const Box& box, const std::array<bool, 4>& is_bound, const EdgeBias& bias);

}  // namespace soslam
