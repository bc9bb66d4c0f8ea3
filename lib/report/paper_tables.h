// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/table.h"
#include "report/results_tree.h"

namespace soslam {

// Means over the objects of one dataset, as the paper prints them.
struct PublishedRow {
  std::string dataset = "average";
  int objects = 0;
  std::map<std::string, double> values;  // by method
};

struct PublishedTable {
  std::string table;     // its number, "I"
  std::string quantity;  // Quantity::key
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
  const PublishedTable* Find(const std::string& number, const Quantity& quantity) const;
};

// Reads schemas/published.schema.json. Throws InputError.
Published ReadPublished(const std::filesystem::path& path);

// A quantity averaged over the objects that have it.
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

}  // namespace soslam
