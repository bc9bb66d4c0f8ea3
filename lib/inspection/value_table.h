// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// A cell of a table of values: a number, a text, a truth value, or null for no value.
using Value = nlohmann::json;

struct ValueColumn {
  std::string name;
  std::string unit = {};   // "m", "deg", "px", "%"; empty without one
  int decimals = 2;        // of numbers that are not whole, in text for people
  std::string field = {};  // of the JSON objects of TableOf, "errors/iou"; empty: the name
};

// Rows have one cell per column.
struct ValueTable {
  std::vector<ValueColumn> columns;
  std::vector<std::vector<Value>> rows;
};

// The table with a row for each of these JSON objects; fields that are absent have no value.
ValueTable TableOf(const std::vector<ValueColumn>& columns, const nlohmann::json& objects);

// Text for a terminal: a line of names, one of units, and the rows, in aligned columns; columns
// without any value are left out. `is_coloured`: with escape sequences.
std::string FormatTable(const ValueTable& table, bool is_coloured);

// RFC 4180 with lines that end in a line feed: the names of all columns, with their units
// ("yaw_deg"), then the rows. Numbers round-trip exactly.
std::string FormatCsv(const ValueTable& table);

}  // namespace soslam
