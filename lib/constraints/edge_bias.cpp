// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/edge_bias.h"

#include <cstddef>

namespace soslam {

Box WithoutBias(const Box& box, const std::array<bool, 4>& is_bound, const EdgeBias& bias) {
  const auto outside_px = [&](size_t side, double extent_px) {
    return is_bound[side] ? 0.0 : bias[side] * extent_px;
  };
  return {box.x_min + outside_px(0, box.Width()), box.y_min + outside_px(1, box.Height()),
          box.x_max - outside_px(2, box.Width()), box.y_max - outside_px(3, box.Height())};
}

}  // namespace soslam
