// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "report/published.h"
#include "report/results_tree.h"

namespace soslam {

// Of single-frame variants: which observations of an object count.
enum class Observations { kAll, kFirst };

// A quantity averaged over the objects that have it.
struct ObjectMean {
  double mean = 0.0;
  int objects = 0;
  int observations = 0;  // of all objects that were compared
};

// None without the quantity; the first observation only of single-frame variants. metrics.json does
// not say how many objects have an angle in their first observation: those that have one in any.
std::optional<ObjectMean> MeanOverObjects(const VariantResult& variant, const Quantity& quantity,
                                          Observations observations);

// Weighted by objects, as the averages of the paper are. Of at least one mean.
ObjectMean WeightedMean(const std::vector<ObjectMean>& means);

// Tables I to IV of the paper: datasets by variants, its own and ours, with the published values in
// rows of their own. The best measured value of a row is bold if it is over all of the row's
// objects; values over fewer have their number behind them. The average is over datasets in which
// every variant has a value that has one in any. Tables without a measured value are left out.
std::vector<Table> PaperTables(const std::vector<DatasetResult>& datasets,
                               const Published& published);

}  // namespace soslam
