// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "orientation/options.h"

namespace soslam {

// Number of vertical planes in which a texture is symmetric, from its TextureAsymmetry::Cost over a
// grid of yaws (rad, half a turn): 2 if it is low at `yaw` and a quarter turn from it, 1 if low at
// `yaw` alone, else 0. None if too few pairs are visible to decide, where the cost is options'
// asymmetry_cost.
std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options);

}  // namespace soslam
