// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// What pages show in any browser, also one that runs no scripts, as HTML: of a dataset (see
// PageData) and of all datasets (see OverviewData). Texts of the data are escaped.
std::string DatasetTables(const nlohmann::json& page);
std::string OverviewTables(const nlohmann::json& overview);

// How much of a dataset's page its data and these tables take.
size_t PageBytes(const nlohmann::json& page);

// Variants of a dataset's page that have more than numbers, as indices into its "variants": what
// has most to show first, maps before views before single frames, and of each what uses most.
std::vector<size_t> DetailedVariants(const nlohmann::json& page);

}  // namespace soslam
