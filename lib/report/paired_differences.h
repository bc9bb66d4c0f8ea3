// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// A comparison of two variants: the errors of `variant` minus those of `baseline`.
struct Comparison {
  std::string variant;
  std::string baseline;
};

// All comparisons within each list of variants: each variant with those before it. Lists are
// separated by commas, variants by blanks: "InitS InitST, OursS OursST". Throws SettingsError for a
// list of fewer than two variants.
std::vector<Comparison> ParseComparisons(const std::string& lists);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

struct PairedDifference {
  int objects = 0;
  double mean = 0.0;
  // Confidence interval of the mean by Student's t, which assumes independent normal differences of
  // the objects. None for fewer than two objects.
  std::optional<Interval> confidence_95;
};

// The t that the absolute value of a Student variable with this many degrees of freedom (>= 1) does
// not exceed with probability 0.95.
double StudentT95(int degrees_of_freedom);

// Requires at least one difference.
PairedDifference MeanDifference(const std::vector<double>& differences);

// One row per comparison and dataset with objects to compare, then one over the objects of all
// datasets with a detector's boxes and one over those of all datasets, each if there are several.
// Bold: the interval excludes zero.
Table DifferencesTable(const std::vector<DatasetResult>& datasets,
                       const std::vector<Comparison>& comparisons, const Quantity& quantity);

// The rows over several datasets alone, with IoU and Rot side by side.
Table DifferencesOverDatasets(const std::vector<DatasetResult>& datasets,
                              const std::vector<Comparison>& comparisons);

// The effect of each part of the methods, for pairs of neighbouring variants with and without it
// that both have metrics: with, without (names), objects, and for iou, rotation_deg and
// yaw_error_deg the mean paired difference and the ends low and high of its 95 % interval (null for
// fewer than two objects).
nlohmann::json PageDifferences(const DatasetResult& dataset);

}  // namespace soslam
