// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace soslam {

// The columns of a table that are read. The optional one may be absent.
struct CsvColumns {
  std::vector<std::string> required;
  std::string optional;
};

struct CsvRow {
  std::string place;                          // "<file>:<line>", for error messages
  std::map<std::string, std::string> fields;  // trimmed, by the names of the columns

  double Real(const std::string& column) const;
};

// Reads a table in CSV whose first line names its columns, in any order and among others; names are
// case-insensitive, with blanks equal to underscores. The separator is the most frequent one of
// comma, semicolon and tab in that line. A field that begins with a quote ends with one; two quotes
// within it stand for one. Throws InputError, naming the line, for a column that is missing or
// there twice, another number of fields than in the first line, and quotes that are not closed.
void ForEachCsvRow(const std::filesystem::path& path, const CsvColumns& columns,
                   const std::function<void(const CsvRow&)>& use);

}  // namespace soslam
