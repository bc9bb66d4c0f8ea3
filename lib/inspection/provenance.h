// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "inspection/inspection.h"

namespace soslam {

// What an artefact's header says of its making: stage and software, inputs, and the settings that
// are not those that the stage has by default.
std::vector<Fact> Provenance(const nlohmann::json& header);

}  // namespace soslam
