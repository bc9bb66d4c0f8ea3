// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// What a table of values holds in one place: a number, a text, a truth value, or null for nothing.
using Value = nlohmann::json;

struct ValueColumn {
  std::string name;
  std::string unit;  // "m", "deg", "px", "%"; empty without one
  int decimals = 2;  // of numbers that are not whole, for people
};

// Rows have one cell per column.
struct ValueTable {
  std::vector<ValueColumn> columns;
  std::vector<std::vector<Value>> rows;
};

// For a terminal: a line of names, one of units, and the rows, in columns that line up; without the
// columns in which no row has anything. `is_coloured`: with escape sequences.
std::string FormatTable(const ValueTable& table, bool is_coloured);

// RFC 4180 with lines that end in \n: the names of all columns, with their units ("yaw_deg"), then
// the rows. Numbers come back bit for bit.
std::string FormatCsv(const ValueTable& table);

}  // namespace soslam
