// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// Worlds of a map as its evaluation sees them: moved into the world of the truth, each by the
// alignment of its segment, covariances along; landmarks with their verdicts. `quality` is
// map_quality of the map's metrics.json.
void ApplyEvaluation(const nlohmann::json& quality, std::vector<World>* worlds);

}  // namespace soslam
