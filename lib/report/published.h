// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/results_tree.h"

namespace soslam {

// Means over the objects of one dataset, as the paper prints them.
struct PublishedRow {
  std::string dataset;
  int objects = 0;
  std::map<std::string, double> values;  // by method
};

struct PublishedTable {
  std::string number;    // "I"
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
  std::vector<PublishedTable> tables;
  PublishedTimes times;

  // Null when there is none.
  const PublishedTable* Find(const std::string& number, const Quantity& quantity) const;
};

// Reads schemas/published.schema.json. Throws InputError.
Published ReadPublished(const std::filesystem::path& path);

}  // namespace soslam
