// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// Tables over all datasets: maps of some variants compared with all true objects (map_quality in
// metrics.json). Without rows if no dataset has such a map.

// What is right: a row of QualityTables for each map, with what was given.
Table MapsTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants);

// The missed objects and the other false landmarks of each map, by reason.
Table LostTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants);

// The found objects of each map, each with the part of its landmark whose correction would gain
// most.
Table LimitsTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants);

}  // namespace soslam
