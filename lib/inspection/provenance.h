// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "inspection/inspection.h"

namespace soslam {

// Provenance of an artefact by its header: stage and software, inputs, and the settings that differ
// from the stage's defaults.
std::vector<Fact> Provenance(const nlohmann::json& header);

}  // namespace soslam
