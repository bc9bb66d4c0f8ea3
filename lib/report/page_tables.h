// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// The part of a page that needs no scripts, as HTML: for a dataset (see PageData) and for all
// datasets (see OverviewData). Texts of the data are escaped.
std::string DatasetTables(const nlohmann::json& page);
std::string OverviewTables(const nlohmann::json& overview);

// Size of a dataset's data and of these tables.
size_t PageBytes(const nlohmann::json& page);

// Variants of a dataset's page that have more than numbers, as indices into its "variants", in the
// order of interest: maps before views before single frames, and of each kind the variant with the
// most parts first.
std::vector<size_t> DetailedVariants(const nlohmann::json& page);

}  // namespace soslam
