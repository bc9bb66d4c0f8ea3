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
  std::string one, two;  // the values, for arrays where they differ most; empty if only the other
                         // artefact has one
  // For numbers: the largest difference, absolute and relative to the larger of the two numbers.
  std::optional<double> absolute, relative;
  size_t differing = 1, of = 1;  // count of numbers
};

struct Differences {
  std::string kind;
  std::vector<Difference> provenance;  // in the headers: software, settings, inputs
  std::vector<Difference> content;     // in everything else
};

// Differences between two artefacts of the same kind. Numbers are equal if they differ by no more
// than `tolerance` times the larger of the two and 1; arrays of numbers of the same shape count as
// one place. Headers are compared exactly. Throws InputError for files that are no artefacts, newer
// than this software, damaged, or of different kinds.
Differences CompareArtefacts(const std::filesystem::path& one, const std::filesystem::path& two,
                             double tolerance);

// Text for a terminal: a summary of the differences, and a table of the places. `is_coloured`: with
// escape sequences.
std::string FormatDifferences(const Differences& differences, double tolerance, bool is_coloured);

}  // namespace soslam
