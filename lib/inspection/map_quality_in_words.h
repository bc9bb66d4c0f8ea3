// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "inspection/inspection.h"

namespace soslam {

// Summary of map_quality of metrics.json: the map as a whole, and the reasons for missed objects
// and false landmarks, one by one if they are few.
std::vector<Fact> MapQualityFacts(const nlohmann::json& quality);

// One row for each landmark.
ValueTable MapQualityTable(const nlohmann::json& quality);

}  // namespace soslam
