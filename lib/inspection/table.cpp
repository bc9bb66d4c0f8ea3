// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/table.h"

#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>

namespace soslam {
namespace {

// "-" for nothing.
std::string ForPeople(const Cell& cell, int decimals) {
  if (cell.is_null()) return "-";
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return cell.get<bool>() ? "yes" : "no";
  return cell.is_number_float() ? fmt::format("{:.{}f}", cell.get<double>(), decimals)
                                : cell.dump();
}

std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string ForCsv(const Cell& cell) {
  if (cell.is_null()) return "";
  if (cell.is_string()) return Quoted(cell.get<std::string>());
  return cell.is_number_float() ? fmt::format("{}", cell.get<double>()) : cell.dump();
}

std::string NameForCsv(const Column& column) {
  if (column.unit.empty()) return column.name;
  return column.name + "_" + (column.unit == "%" ? "percent" : column.unit);
}

// A column as it is printed: name, unit, then one text per row.
struct PrintedColumn {
  std::vector<std::string> texts;
  size_t width = 0;
  bool is_text = false;
};

std::vector<PrintedColumn> PrintedColumns(const Table& table) {
  std::vector<PrintedColumn> printed;
  for (size_t k = 0; k < table.columns.size(); ++k) {
    const Column& column = table.columns[k];
    if (std::ranges::all_of(table.rows, [&](const auto& row) { return row[k].is_null(); }))
      continue;
    PrintedColumn one{{column.name, column.unit}, 0, false};
    for (const std::vector<Cell>& row : table.rows) {
      one.texts.push_back(ForPeople(row[k], column.decimals));
      one.is_text |= row[k].is_string() || row[k].is_boolean();
    }
    for (const std::string& text : one.texts) one.width = std::max(one.width, WidthOf(text));
    printed.push_back(std::move(one));
  }
  return printed;
}

// Texts to the left, numbers to the right.
std::string PrintedLine(const std::vector<PrintedColumn>& columns, size_t line) {
  std::string text;
  for (const PrintedColumn& column : columns) {
    const std::string& cell = column.texts[line];
    const std::string padding(column.width - WidthOf(cell), ' ');
    text += (text.empty() ? "" : "  ") + (column.is_text ? cell + padding : padding + cell);
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

size_t WidthOf(const std::string& text) {
  const auto is_continuation = [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
  };
  return text.size() - static_cast<size_t>(std::ranges::count_if(text, is_continuation));
}

std::string FormatTable(const Table& table, bool is_coloured) {
  const std::vector<PrintedColumn> columns = PrintedColumns(table);
  std::string text;
  for (size_t line = 0; line < table.rows.size() + 2; ++line) {
    const std::string printed = PrintedLine(columns, line);
    if (line == 1 && printed.empty()) continue;  // no column has a unit
    const fmt::emphasis emphasis = line == 0 ? fmt::emphasis::bold : fmt::emphasis::faint;
    text +=
        is_coloured && line < 2 ? fmt::format(fmt::text_style(emphasis), "{}", printed) : printed;
    text += '\n';
  }
  return text;
}

std::string FormatCsv(const Table& table) {
  std::string text;
  const auto add_line = [&](const auto& items, const auto& format) {
    for (size_t i = 0; i < items.size(); ++i) text += (i > 0 ? "," : "") + format(items[i]);
    text += '\n';
  };
  add_line(table.columns, [](const Column& column) { return Quoted(NameForCsv(column)); });
  for (const std::vector<Cell>& row : table.rows) add_line(row, ForCsv);
  return text;
}

}  // namespace soslam
