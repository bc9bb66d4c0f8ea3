// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// `quality` is map_quality of the metrics.json that belongs to the map.

// Gives each landmark the verdict of its evaluation.
void AddVerdicts(const nlohmann::json& quality, std::vector<World>* worlds);

// Moves each world to the true one by the alignment of its segment, including covariances.
void AlignWorlds(const nlohmann::json& quality, std::vector<World>* worlds);

}  // namespace soslam
