// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// `quality` is map_quality of the metrics.json that was made of the map.

// Gives each landmark what its evaluation says of it.
void AddVerdicts(const nlohmann::json& quality, std::vector<World>* worlds);

// Moves each world into that of the truth, as the alignment of its segment does; covariances along.
void AlignWorlds(const nlohmann::json& quality, std::vector<World>* worlds);

}  // namespace soslam
