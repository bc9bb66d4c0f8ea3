// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>

#include "base/table.h"
#include "base/text.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

std::string ForPeople(const Value& value, int decimals) {
  if (value.is_null()) return kNoValue;
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_number_float() ? fmt::format("{:.{}f}", value.get<double>(), decimals)
                                 : value.dump();
}

std::string ForCsv(const Value& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

std::string NameForCsv(const ValueColumn& column) {
  if (column.unit.empty()) return column.name;
  return column.name + "_" + (column.unit == "%" ? "percent" : column.unit);
}

// A column as printed: name, unit, then one text per row.
struct PrintedColumn {
  std::vector<std::string> texts;
  size_t width = 0;
  bool is_text = false;
};

std::vector<PrintedColumn> PrintedColumns(const ValueTable& table) {
  std::vector<PrintedColumn> printed;
  for (size_t k = 0; k < table.columns.size(); ++k) {
    const ValueColumn& column = table.columns[k];
    if (std::ranges::all_of(table.rows, [&](const auto& row) { return row[k].is_null(); }))
      continue;
    PrintedColumn one{{column.name, column.unit}, 0, false};
    for (const std::vector<Value>& row : table.rows) {
      one.texts.push_back(ForPeople(row[k], column.decimals));
      one.is_text |= row[k].is_string() || row[k].is_boolean();
    }
    for (const std::string& text : one.texts) one.width = std::max(one.width, WidthOf(text));
    printed.push_back(std::move(one));
  }
  return printed;
}

// Texts are aligned left, numbers right.
std::string PrintedLine(const std::vector<PrintedColumn>& columns, size_t line) {
  std::string text;
  for (const PrintedColumn& column : columns) {
    const std::string& value = column.texts[line];
    const std::string padding(column.width - WidthOf(value), ' ');
    text += (text.empty() ? "" : "  ") + (column.is_text ? value + padding : padding + value);
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

ValueTable TableOf(const std::vector<ValueColumn>& columns, const nlohmann::json& objects) {
  ValueTable table{columns, {}};
  for (const nlohmann::json& object : objects) {
    std::vector<Value>& row = table.rows.emplace_back();
    for (const ValueColumn& column : columns) {
      const std::string& field = column.field.empty() ? column.name : column.field;
      row.push_back(object.value(nlohmann::json::json_pointer("/" + field), Value()));
    }
  }
  return table;
}

std::string FormatTable(const ValueTable& table, bool is_coloured) {
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

std::string FormatCsv(const ValueTable& table) {
  Table texts;
  for (const ValueColumn& column : table.columns) texts.header.push_back(NameForCsv(column));
  for (const std::vector<Value>& row : table.rows) {
    std::vector<Cell> cells;
    for (const Value& value : row) cells.emplace_back(ForCsv(value));
    texts.rows.push_back(std::move(cells));
  }
  return ToCsv(texts);
}

}  // namespace soslam
