// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/results_tree.h"

namespace soslam {

// The findings in all artefacts of a dataset's variants, errors first, each once:
//   severity ("error" or "warning"), check, found, expected, cause, remedy: as in the artefact;
//   where: "sequence.json of all variants", "map.json of OursP, OursPT"
nlohmann::json PageFindings(const DatasetResult& dataset);

// The same as HTML, escaped; empty if there are none.
std::string FindingsHtml(const nlohmann::json& findings);

}  // namespace soslam
