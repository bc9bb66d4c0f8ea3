// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// All summary metrics of one dataset, one row per variant: the paper's variants always, with "-" if
// they have no metrics; others if they have metrics.
Table DatasetTable(const DatasetResult& dataset);

// A row for each dataset: where its data come from, how much there is, and what marks it.
Table SequencesTable(const std::vector<DatasetResult>& datasets);

// A variant's name and its metrics.json.
using NamedMetrics = std::pair<std::string, nlohmann::json>;

// Maps compared with all true objects (map_quality of metrics.json), a row for each variant that
// has it: counts of found objects, and their errors. Empty if no variant has it.
std::vector<Table> QualityTables(const std::string& dataset,
                                 const std::vector<NamedMetrics>& variants);
std::vector<Table> QualityTables(const DatasetResult& dataset);

// The true objects that a map misses and its false landmarks, each with the reason.
Table MistakesTable(const nlohmann::json& metrics);

}  // namespace soslam
