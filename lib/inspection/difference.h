// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// A place at which two artefacts differ.
struct Difference {
  std::string place;     // JSON pointer, or path in the HDF5 file
  std::string one, two;  // the values, of arrays where they differ most; empty where there is none
  // Of numbers: the largest difference, and the largest as a share of the larger of the two.
  std::optional<double> absolute, relative;
  size_t differing = 1, of = 1;  // numbers
};

struct Differences {
  std::string kind;
  std::vector<Difference> provenance;  // in the headers: software, settings, inputs
  std::vector<Difference> content;     // in all else
};

// What differs between two artefacts of one kind. Numbers are equal that differ by no more than
// `tolerance` times the larger of the two and 1; arrays of numbers of one shape count as one place.
// Headers are compared exactly. Throws InputError for files that are no artefacts, newer than this
// software, damaged, or of different kinds.
Differences CompareArtefacts(const std::filesystem::path& one, const std::filesystem::path& two,
                             double tolerance);

// For a terminal: how much differs, and a table of the places. `is_coloured`: with escape
// sequences.
std::string FormatDifferences(const Differences& differences, double tolerance, bool is_coloured);

}  // namespace soslam
