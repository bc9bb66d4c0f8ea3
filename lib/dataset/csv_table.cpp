// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

// Content of the quoted field at the beginning of `rest`, which becomes the text after the field.
std::string TakeQuoted(std::string_view* rest, const std::string& place) {
  std::string field;
  for (size_t i = 1; i < rest->size(); ++i) {
    if ((*rest)[i] != '"') {
      field += (*rest)[i];
    } else if (i + 1 < rest->size() && (*rest)[i + 1] == '"') {
      field += (*rest)[++i];
    } else {
      rest->remove_prefix(i + 1);
      return std::string(Trimmed(field));
    }
  }
  throw InputError(place + ": has a quote that is not closed; expected \"field\" on one line");
}

// Separator of the fields: the most frequent one of comma, semicolon and tab in the header.
char SeparatorOf(std::string_view header) {
  char most = ',';
  for (const char separator : {';', '\t'}) {
    if (std::ranges::count(header, separator) > std::ranges::count(header, most)) most = separator;
  }
  return most;
}

// The trimmed fields.
std::vector<std::string> SplitCsvLine(std::string_view line, char separator,
                                      const std::string& place) {
  std::vector<std::string> fields;
  for (std::string_view rest = line;;) {
    const size_t begin = rest.find_first_not_of(' ');
    const bool is_quoted = begin != std::string_view::npos && rest[begin] == '"';
    if (is_quoted) {
      rest.remove_prefix(begin);
      fields.push_back(TakeQuoted(&rest, place));
    }
    const size_t end = std::min(rest.find(separator), rest.size());
    const std::string_view text = Trimmed(rest.substr(0, end));
    if (!is_quoted) fields.emplace_back(text);
    if (is_quoted && !text.empty()) {
      throw InputError(fmt::format("{}: has '{}' after a quoted field; expected '{}'", place, text,
                                   separator == '\t' ? "tab" : std::string(1, separator)));
    }
    if (end == rest.size()) return fields;
    rest.remove_prefix(end + 1);
  }
}

// Index of each column that is read, by its name.
std::map<std::string, size_t> PositionsOf(const CsvColumns& columns,
                                          const std::vector<std::string>& header,
                                          const std::string& place) {
  const auto refuse = [&](const std::string& column, const char* how_often) {
    throw InputError(fmt::format("{}: column '{}' is {}; expected each of {} once", place, column,
                                 how_often, fmt::join(columns.required, ",")));
  };
  std::map<std::string, size_t> positions;
  for (size_t i = 0; i < header.size(); ++i) {
    std::string name = LowerCase(header[i]);
    std::ranges::replace(name, ' ', '_');
    const bool is_read = (!columns.optional.empty() && name == columns.optional) ||
                         std::ranges::find(columns.required, name) != columns.required.end();
    if (is_read && !positions.emplace(name, i).second) refuse(name, "twice");
  }
  for (const std::string& column : columns.required) {
    if (!positions.contains(column)) refuse(column, "missing");
  }
  return positions;
}

}  // namespace

double CsvRow::Real(const std::string& column) const {
  return ParseReal(fields.at(column), place, column);
}

void ForEachCsvRow(const std::filesystem::path& path, const CsvColumns& columns,
                   const std::function<void(const CsvRow&)>& use) {
  const std::vector<TextLine> lines = ReadTableLines(path);
  if (lines.empty()) {
    throw InputError(fmt::format("{}: is empty; expected a header {}", path.string(),
                                 fmt::join(columns.required, ",")));
  }
  const char separator = SeparatorOf(lines[0].text);
  const auto header = SplitCsvLine(lines[0].text, separator, lines[0].place);
  const auto positions = PositionsOf(columns, header, lines[0].place);
  for (size_t i = 1; i < lines.size(); ++i) {
    const auto fields = SplitCsvLine(lines[i].text, separator, lines[i].place);
    if (fields.size() != header.size()) {
      throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has",
                                   lines[i].place, fields.size(), header.size()));
    }
    CsvRow row{lines[i].place, {}};
    for (const auto& [column, position] : positions) row.fields[column] = fields[position];
    use(row);
  }
}

}  // namespace soslam
