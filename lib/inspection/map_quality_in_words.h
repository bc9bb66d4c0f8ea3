// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "inspection/inspection.h"

namespace soslam {

// What map_quality of metrics.json says of the map as a whole, and why objects are missed and
// landmarks false, one by one as far as they are few.
std::vector<Fact> MapQualityFacts(const nlohmann::json& quality);

// A row for each landmark.
ValueTable MapQualityTable(const nlohmann::json& quality);

}  // namespace soslam
