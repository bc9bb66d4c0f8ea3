// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "orientation/options.h"

namespace soslam {

// In how many vertical planes a texture is symmetric, from its TextureAsymmetry::Cost over a grid
// of yaws (rad, half a turn): where it is low at `yaw` and a quarter turn from it, 2; where at
// `yaw` alone, 1; else 0. None where too few pairs are visible to tell, which costs all of options'
// asymmetry_cost.
std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options);

}  // namespace soslam
