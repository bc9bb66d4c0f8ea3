// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// All that the metrics of one dataset say, one row per variant: the paper's variants always, those
// without metrics with "-"; others where they have metrics.
Table DatasetTable(const DatasetResult& dataset);

}  // namespace soslam
