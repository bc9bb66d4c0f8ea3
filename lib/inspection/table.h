// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// What a table holds in one place: a number, a text, a truth value, or null for nothing.
using Cell = nlohmann::json;

struct Column {
  std::string name;
  std::string unit;  // "m", "deg", "px", "%"; empty without one
  int decimals = 2;  // of numbers that are not whole, for people
};

// Rows have one cell per column.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

// For a terminal: a line of names, one of units, and the rows, in columns that line up; without the
// columns in which no row has anything. `is_coloured`: with escape sequences.
std::string FormatTable(const Table& table, bool is_coloured);

// RFC 4180 with lines that end in \n: the names of all columns, with their units ("yaw_deg"), then
// the rows. Numbers come back bit for bit.
std::string FormatCsv(const Table& table);

// The width of a text in UTF-8 on a terminal, in characters.
size_t WidthOf(const std::string& text);

}  // namespace soslam
