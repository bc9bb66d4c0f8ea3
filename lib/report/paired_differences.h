// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// What a change is worth: the errors of `variant` minus those of `baseline`.
struct Comparison {
  std::string variant;
  std::string baseline;
};

// All comparisons within each list of variants: each with those before it. Lists are divided by
// commas, variants by blanks: "InitS InitST, OursS OursST". Throws SettingsError for a list of
// fewer than two.
std::vector<Comparison> ParseComparisons(const std::string& lists);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

struct PairedDifference {
  int objects = 0;
  double mean = 0.0;
  // For the mean: t interval, which takes the objects' differences as independent and normal. None
  // of fewer than two.
  std::optional<Interval> confidence_95;
};

// The t of which a Student variable with that many degrees of freedom (>= 1) stays below in
// absolute value with probability 0.95.
double StudentT95(int degrees_of_freedom);

// Of at least one difference.
PairedDifference MeanDifference(const std::vector<double>& differences);

// By object: of those for which both variants have the quantity, in the order of `variant`.
std::vector<double> DifferencesByObject(const VariantResult& variant, const VariantResult& baseline,
                                        const Quantity& quantity);

// One row per comparison and dataset with objects to compare, then one over the objects of all
// datasets if there are several. Bold: the interval excludes zero.
Table DifferencesTable(const std::vector<DatasetResult>& datasets,
                       const std::vector<Comparison>& comparisons, const Quantity& quantity);

}  // namespace soslam
