// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace soslam {

// The part of a page that needs no scripts, as HTML: for a dataset (see PageData) and for all
// datasets (see OverviewData). Texts of the data are escaped.
std::string DatasetTables(const nlohmann::json& page);
std::string OverviewTables(const nlohmann::json& overview);

}  // namespace soslam
