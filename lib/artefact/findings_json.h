// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/finding.h"

namespace soslam {

// The list "findings" of JSON artefacts, which is absent when empty.
nlohmann::json FindingsToJson(const std::vector<Finding>& findings);

// The findings in an artefact of any kind and version.
std::vector<Finding> FindingsFromJson(const nlohmann::json& artefact);

}  // namespace soslam
