// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// All summary metrics of one dataset, one row per variant: the paper's variants always, with "-" if
// they have no metrics; others if they have metrics.
Table DatasetTable(const DatasetResult& dataset);

}  // namespace soslam
