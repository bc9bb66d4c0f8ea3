// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace soslam {

// Text of a cell without a value.
inline constexpr const char* kNoValue = "-";

struct Cell {
  Cell(std::string content, bool is_bold = false) : text(std::move(content)), bold(is_bold) {}
  Cell(const char* content) : text(content) {}

  std::string text;  // UTF-8, one line, nothing escaped
  bool bold = false;
};

// A table of results for people and programs. Every row has as many cells as the header.
struct Table {
  std::string name;   // of its files, and its label in LaTeX: "table_1_single_frame_iou"
  std::string title;  // one line
  std::vector<std::string> header;
  std::vector<std::vector<Cell>> rows;
  size_t left_columns = 1;         // the first columns are names, aligned left; numbers follow
  std::vector<std::string> notes;  // one line each, shown below the table
};

// A second-level heading, the table with padded columns, and its notes.
std::string ToMarkdown(const Table& table);

// Header and rows as in RFC 4180 with "\n" line ends; without title, notes and bold.
std::string ToCsv(const Table& table);

// A table* environment for \input; it needs the package booktabs. Cells without a value are dashes.
std::string ToLatex(const Table& table);

// A CSV field, quoted if necessary (RFC 4180).
std::string CsvText(const std::string& text);

}  // namespace soslam
