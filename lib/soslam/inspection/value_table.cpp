// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "soslam/base/table.h"
#include "soslam/base/text.h"
#include "soslam/inspection/inspection.h"

namespace soslam {
namespace {

double LargestIn(const Value& value) {
  if (value.is_number_float()) return std::abs(value.get<double>());
  double largest = 0.0;
  if (value.is_array()) {
    for (const Value& item : value) largest = std::max(largest, LargestIn(item));
  }
  return std::isfinite(largest) ? largest : 0.0;
}

bool IsVector(const Value& value) {
  return value.is_array() && !value.empty() &&
         std::ranges::none_of(value, [](const Value& item) { return item.is_structured(); });
}

// How many numbers each value of a column has; 0 unless all have equally many.
size_t CountParts(const ValueTable& table, size_t column) {
  size_t parts = 0;
  for (const std::vector<Value>& row : table.rows) {
    if (row[column].is_null()) continue;
    if (!IsVector(row[column]) || (parts > 0 && row[column].size() != parts)) return 0;
    parts = row[column].size();
  }
  return parts;
}

std::string ForCsv(const Value& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

// A column as printed: the lines of its name, then one text per row.
struct PrintedColumn {
  std::vector<std::string> texts;
  size_t width = 0;
  bool is_text = false;
};

std::vector<std::string> SplitName(const std::string& name) {
  std::vector<std::string> lines;
  for (const std::string_view part : SplitFields(name, '/')) {
    if (!lines.empty()) lines.back() += '/';
    lines.emplace_back(part);
  }
  return lines;
}

std::vector<PrintedColumn> PrintedColumns(const ValueTable& table, size_t rows, size_t name_lines) {
  std::vector<PrintedColumn> printed;
  for (size_t k = 0; k < table.columns.size(); ++k) {
    const auto is_empty = [&](const auto& row) { return row[k].is_null() || row[k] == ""; };
    if (std::ranges::all_of(table.rows, is_empty)) continue;
    PrintedColumn column{SplitName(table.columns[k].name)};
    column.texts.insert(column.texts.begin(), name_lines - column.texts.size(), "");
    double largest = 0.0;
    for (size_t i = 0; i < rows; ++i) largest = std::max(largest, LargestIn(table.rows[i][k]));
    for (size_t i = 0; i < rows; ++i) {
      const Value& value = table.rows[i][k];
      column.texts.push_back(InWords(value, largest));
      column.is_text |= value.is_string() || value.is_boolean() || value.is_object();
    }
    for (const std::string& text : column.texts) {
      column.width = std::max(column.width, CountCharacters(text));
    }
    printed.push_back(std::move(column));
  }
  return printed;
}

}  // namespace

std::string InWords(const Value& value, double largest) {
  constexpr size_t kMostItems = 6, kMostLetters = 80;
  if (value.is_null()) return kNoValue;
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) {
    const double digits = largest > 0.0 ? 3.0 - std::trunc(std::log10(largest)) : 3.0;
    std::string text =
        fmt::format("{:.{}f}", value.get<double>(), static_cast<int>(std::clamp(digits, 0.0, 9.0)));
    const bool is_zero = text.find_first_not_of("-0.") == text.npos;
    return is_zero && text[0] == '-' ? text.substr(1) : text;
  }
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    return CountCharacters(text) <= kMostLetters ? text : text.substr(0, kMostLetters) + "...";
  }
  if (!value.is_structured()) return value.dump();
  if (value.empty()) return "none";
  if (value.is_array() && !IsVector(value)) {
    return value[0].is_array() ? fmt::format("{} x {}", value.size(), value[0].size())
                               : std::to_string(value.size());
  }
  std::vector<std::string> words;
  for (const auto& [name, item] : value.items()) {
    words.push_back((value.is_object() ? name + " " : "") + InWords(item, largest));
  }
  return NamesInWords(words, kMostItems);
}

std::string InWords(const Value& value) { return InWords(value, LargestIn(value)); }

std::string FormatTable(const ValueTable& table, bool is_coloured, const TableLimits& limits) {
  const size_t rows = std::min(limits.rows, table.rows.size());
  size_t name_lines = 0;
  for (const ValueColumn& column : table.columns) {
    name_lines = std::max(name_lines, SplitName(column.name).size());
  }
  const std::vector<PrintedColumn> columns = PrintedColumns(table, rows, name_lines);
  constexpr size_t kRepeated = 2;
  std::string text;
  for (size_t next = 0; next < columns.size();) {
    std::vector<PrintedColumn> part;
    size_t width = 0;
    const auto add = [&](const PrintedColumn& column) {
      part.push_back(column);
      width += column.width + 2;
    };
    if (next > 0) std::for_each_n(columns.begin(), kRepeated, add);
    do {
      add(columns[next++]);
    } while (next < columns.size() && width + columns[next].width <= limits.width);
    if (!text.empty()) text += '\n';
    for (size_t line = 0; line < name_lines + rows; ++line) {
      std::string printed;
      for (const PrintedColumn& column : part) {
        const std::string& value = column.texts[line];
        const std::string padding(column.width - CountCharacters(value), ' ');
        printed +=
            (printed.empty() ? "" : "  ") + (column.is_text ? value + padding : padding + value);
      }
      printed.erase(printed.find_last_not_of(' ') + 1);
      if (printed.empty()) continue;
      const bool is_name = is_coloured && line < name_lines;
      text += is_name ? fmt::format(fmt::text_style(fmt::emphasis::bold), "{}", printed) : printed;
      text += '\n';
    }
  }
  return text;
}

std::string FormatCsv(const ValueTable& table) {
  Table texts;
  std::vector<size_t> parts;
  for (size_t k = 0; k < table.columns.size(); ++k) {
    parts.push_back(CountParts(table, k));
    const std::string& name = table.columns[k].name;
    if (parts[k] == 0) texts.header.push_back(name);
    for (size_t i = 0; i < parts[k]; ++i) texts.header.push_back(fmt::format("{}/{}", name, i));
  }
  for (const std::vector<Value>& row : table.rows) {
    std::vector<Cell> cells;
    for (size_t k = 0; k < row.size(); ++k) {
      if (parts[k] == 0) cells.emplace_back(ForCsv(row[k]));
      for (size_t i = 0; i < parts[k]; ++i) {
        cells.emplace_back(row[k].is_null() ? "" : ForCsv(row[k][i]));
      }
    }
    texts.rows.push_back(std::move(cells));
  }
  return ToCsv(texts);
}

}  // namespace soslam
