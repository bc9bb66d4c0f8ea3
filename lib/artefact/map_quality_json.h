// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/map_quality.h"
#include "model/sequence.h"

namespace soslam {

// The field "map_quality" of metrics.json.
nlohmann::json MapQualityToJson(const MapQuality& quality, const Sequence& sequence);

}  // namespace soslam
