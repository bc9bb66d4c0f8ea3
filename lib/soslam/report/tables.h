// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/table.h"
#include "soslam/report/results_tree.h"

namespace soslam {

// All summary metrics of one dataset, one row per variant: the paper's variants always, with "-" if
// they have no metrics; others if they have metrics.
Table DatasetTable(const DatasetResult& dataset);

// A row for each dataset: where its data come from, how much there is, and what marks it.
Table SequencesTable(const std::vector<DatasetResult>& datasets);

// Maps compared with all true objects (map_quality of metrics.json), a row for each variant that
// has it: counts of found objects, and their errors. Empty if no variant has it.
std::vector<Table> QualityTables(const DatasetResult& dataset);

// The true objects that a map misses and its false landmarks, each with the reason.
Table MistakesTable(const Metrics& metrics);

// Tables over all datasets: maps of some variants compared with all true objects (map_quality in
// metrics.json). Without rows if no dataset has such a map.

// How much of each map is right: a row of QualityTables with what was given.
Table MapsTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants);

// The missed objects and the other false landmarks of each map, by reason.
Table LostTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants);

// The found objects of each map, each with its errors and WhatIf.
Table LimitsTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants);

// IoU in frames and the means of WhatIf, also of single-frame estimates.
Table WhatIfTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants);

// Means over the objects of one dataset, as the paper prints them.
struct PublishedRow {
  std::string dataset = "average";
  int objects = 0;
  std::map<std::string, double> values;  // by method
};

struct PublishedTable {
  std::string table;     // its number, "I"
  std::string quantity;  // Metric::Key
  std::string source;
  std::vector<PublishedRow> rows;  // in the paper's order
  PublishedRow average;            // as printed, not computed from the rows
};

struct PublishedTime {
  std::string variant;
  double ms_mean = 0.0;
  double ms_sigma = 0.0;
  double observations = 0.0;  // mean number per landmark
};

struct PublishedTimes {
  std::string source;
  std::string dataset;
  std::string machine;
  std::vector<PublishedTime> values;
};

// The values in the paper's tables.
struct Published {
  std::string protocol;  // how these values came about, one line
  std::vector<PublishedTable> tables;
  PublishedTimes times;

  // Null when there is none.
  const PublishedTable* Find(const std::string& number, const Metric& metric) const;
};

template <typename Visitor>
void DescribeMeans(Visitor& visit, PublishedRow& row) {
  visit.Field("objects", &row.objects, "number", kAtLeastOne);
  visit.Field("values", &row.values, "by method; what the publication leaves out is absent");
}
template <typename Visitor>
void Describe(Visitor& visit, PublishedRow& row) {
  visit.Field("dataset", &row.dataset, "as folders of datasets are named", kNotEmpty);
  DescribeMeans(visit, row);
}
template <typename Visitor>
void Describe(Visitor& visit, PublishedTable& table) {
  visit.Field("table", &table.table, "its number, as I", kNotEmpty);
  visit.Field("quantity", &table.quantity, "iou or rotation_deg: means over objects", kNotEmpty);
  visit.Check([&] { return NotOneOf("table", table.table, {"I", "II", "III", "IV"}); });
  visit.Check([&] { return NotOneOf("quantity", table.quantity, {"iou", "rotation_deg"}); });
  visit.Field("source", &table.source, "where it is printed", kNotEmpty);
  visit.Field("rows", &table.rows, "in the order of the publication");
  visit.Field("average", &table.average, "as printed", {},
              [](auto& visit, PublishedRow& row) { DescribeMeans(visit, row); });
}
template <typename Visitor>
void Describe(Visitor& visit, PublishedTime& time) {
  visit.Field("variant", &time.variant, "method", kNotEmpty);
  visit.Field("ms_mean", &time.ms_mean, "milliseconds per landmark", kNotNegative);
  visit.Field("ms_sigma", &time.ms_sigma, "standard deviation of that", kNotNegative);
  visit.Field("observations", &time.observations, "mean number per landmark", kNotNegative);
}
template <typename Visitor>
void Describe(Visitor& visit, PublishedTimes& times) {
  visit.Field("source", &times.source, "where they are printed", kNotEmpty);
  visit.Field("dataset", &times.dataset, "of the publication", kNotEmpty);
  visit.Field("machine", &times.machine, "on which they were measured", kNotEmpty);
  visit.Field("values", &times.values, "by method");
}
// pipelines/published.json.
template <typename Visitor>
void Describe(Visitor& visit, Published& published) {
  std::string description;
  visit.OrAbsent("description", &description, "for readers of the file");
  visit.OrAbsent("protocol", &published.protocol, "how the values came about, one line", kNotEmpty);
  visit.Field("tables", &published.tables, "tables I to IV");
  visit.Field("times", &published.times, "run times");
}

// Reads pipelines/published.json. Throws InputError.
Published ReadPublished(const std::filesystem::path& path);

// A metric averaged over the objects that have it.
struct ObjectMean {
  double mean = 0.0;
  int objects = 0;
  int observations = 0;  // of all objects that were compared
};

// Mean weighted by the number of objects, like the averages of the paper. Requires at least one
// mean.
ObjectMean WeightedMean(const std::vector<ObjectMean>& means);

// Tables I to IV of the paper: datasets by variants, its own and ours, with the published values in
// rows of their own; notes say in what datasets differ from the published ones. The best measured
// value of a row is bold if it is over all of the row's objects; values over fewer objects have
// their number in brackets. The average is over datasets that have a value for every variant with a
// value in any dataset; the row of a detector's boxes is over the objects of such datasets that
// every variant has. Tables without a measured value are left out.
std::vector<Table> PaperTables(const std::vector<DatasetResult>& datasets,
                               const Published& published);

// Run time per landmark. Single-frame variants: edges, tracks, initialisation and refinement,
// per observation; SVD and MultiView: the same, per object; maps: the back end alone, per object.
struct LandmarkTime {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
  double observations = 0.0;  // mean number per landmark
};

// Counts of a sequence.json.
struct SequenceCounts {
  int observations = 0;
  int objects = 0;  // objects that were observed
};

// Throws InputError as ReadSequence.
SequenceCounts CountObservations(const std::filesystem::path& sequence_file);

// Empty without metrics, observations, or the timing of one of these stages.
std::optional<LandmarkTime> TimePerLandmark(const VariantResult& variant,
                                            const SequenceCounts& counts);

// Table V of the paper: datasets by variants, with the published times; without rows when no
// variant has a time. Throws InputError as CountObservations.
Table TimeTable(const std::vector<DatasetResult>& datasets, const Published& published);

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
  double mean = 0.0;
  // Confidence interval of the mean by Student's t, which assumes independent normal differences of
  // the objects. None for fewer than two objects.
  std::optional<Interval> confidence_95;

  // True if the interval excludes zero.
  bool IsClear() const;
};

// The t that the absolute value of a Student variable with this many degrees of freedom (>= 1) does
// not exceed with probability 0.95.
double StudentT95(int degrees_of_freedom);

// Requires at least one difference.
PairedDifference MeanDifference(const std::vector<double>& differences);

// "+0.245 (+0.194 to +0.296)", bold if the interval excludes zero.
Cell WithInterval(const PairedDifference& difference, const Metric& metric);

// One row per comparison and dataset with objects to compare, then one over the objects of all
// datasets with a detector's boxes and one over those of all datasets, each if there are several.
// Bold: the interval excludes zero.
Table DifferencesTable(const std::vector<DatasetResult>& datasets,
                       const std::vector<Comparison>& comparisons, const ObjectMetric& metric);

// The rows over several datasets alone, with IoU and Rot side by side.
Table DifferencesOverDatasets(const std::vector<DatasetResult>& datasets,
                              const std::vector<Comparison>& comparisons);

// The effect of one more part of the methods: the first variant has it, the baseline has not.
struct PartDifference {
  Comparison parts;
  size_t objects = 0;
  // One for each of kMeanMetrics; none where no object has it with both variants.
  std::vector<std::optional<PairedDifference>> of_metrics;
};

// The differences between all pairs of neighbouring variants that both have metrics.
std::vector<PartDifference> PartDifferences(const DatasetResult& dataset);

// A page of prose with tables in it, each between two lines
//
//     <!-- table: NAME -->
//     <!-- end: SHA-256 of the lines between -->
//
// or, before the page is filled for the first time, "<!-- end -->" as the second.

// The page with the present tables between its markers. `name` of the page is for messages. Throws
// InputError for a table that there is not and for markers without their other half.
std::string FillPage(const std::string& page, const std::vector<Table>& tables,
                     const std::string& name);

}  // namespace soslam
