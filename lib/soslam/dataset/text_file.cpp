// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/image/file_kind.h"
#include "soslam/system/run_log.h"

namespace soslam {

bool IsUtf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

namespace {

// The lines of a text, all of them or neither blank ones nor comments.
std::vector<TextLine> SplitLines(const std::string& text, const std::string& name, bool all) {
  CheckIsText(text, name, "UTF-8 text");
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  const char line_end = rest.find('\n') == rest.npos ? '\r' : '\n';
  std::vector<TextLine> lines;
  for (size_t number = 1; !rest.empty(); ++number) {
    std::string line(rest.substr(0, rest.find(line_end)));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    line.erase(line.find_last_not_of('\r') + 1);
    const bool is_comment = Trimmed(line).starts_with('#');
    if (!all && (is_comment || Trimmed(line).empty())) continue;
    std::string place = fmt::format("{}:{}", name, number);
    if (!is_comment && line.find('\0') != line.npos) {
      throw InputError(place + ": has a zero byte, as UTF-16 text has; expected UTF-8");
    }
    if (!is_comment && !IsUtf8(line)) throw InputError(place + ": is not UTF-8 text");
    lines.push_back({std::move(place), std::move(line)});
    constexpr size_t kMaxLines = 20'000'000;  // short lines take much more memory than in the file
    if (lines.size() > kMaxLines) {
      throw InputError(fmt::format("{}: has more than {} lines", name, kMaxLines));
    }
  }
  return lines;
}

// Lines without the characters of `blanks` at both ends; neither blank lines nor comments.
std::vector<TextLine> LinesWithout(std::string_view blanks, const std::string& text,
                                   const std::string& name) {
  std::vector<TextLine> lines = SplitLines(text, name, /*all=*/false);
  for (TextLine& line : lines) {
    line.text.erase(line.text.find_last_not_of(blanks) + 1);
    line.text.erase(0, line.text.find_first_not_of(blanks));
  }
  return lines;
}

template <typename Number>
bool ParseWhole(std::string_view text, Number* number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *number);
  return error == std::errc() && stop == end;
}

}  // namespace

std::string ReadWholeFile(const std::filesystem::path& path, const char* kind) {
  constexpr std::uintmax_t kMaxBytes = 1 << 30;
  RecordInput(path);
  std::ifstream stream;
  if (IsFile(path)) stream.open(path, std::ios::binary);  // opening a pipe would block
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
  if (!stream.is_open() || failed) {
    throw InputError(fmt::format("{}: {}; expected a {}", path.string(),
                                 IsFolder(path) ? "is a folder" : "cannot be read", kind));
  }
  if (bytes > kMaxBytes) {
    throw InputError(fmt::format("{}: has {} bytes; expected a {} of at most {}", path.string(),
                                 bytes, kind, kMaxBytes));
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<TextLine> ReadTextLines(const std::filesystem::path& path) {
  return TextLines(ReadWholeFile(path), path.string());
}

std::vector<TextLine> TextLines(const std::string& text, const std::string& name) {
  return LinesWithout(kBlanks, text, name);
}

std::vector<TextLine> RawLines(const std::string& text, const std::string& name) {
  return SplitLines(text, name, /*all=*/true);
}

double ParseReal(std::string_view text, const std::string& place, const std::string& field) {
  if (const auto number = ParseNumber(text)) return *number;
  std::string with_point(text);
  const size_t comma = with_point.find(',');
  if (comma != with_point.npos) with_point[comma] = '.';
  throw InputError(fmt::format("{}: {} is '{}'; expected a finite number{}", place, field, text,
                               ParseNumber(with_point) ? ", with a decimal point" : ""));
}

int ParseInteger(std::string_view text, const std::string& place, const std::string& field) {
  int number = 0;
  if (!ParseWhole(text, &number)) {
    throw InputError(fmt::format("{}: {} is '{}'; expected an integer", place, field, text));
  }
  return number;
}

std::optional<double> ParseNumber(std::string_view text) {
  double number = 0.0;
  return ParseWhole(text, &number) && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<std::vector<double>> ParseNumbers(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : SplitWords(text)) {
    const auto number = ParseNumber(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

void RefuseSetting(const std::string& option, std::string_view found, const std::string& expected) {
  throw SettingsError(fmt::format("{}: found '{}'; expected {}", option, found, expected));
}

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
std::map<std::string, size_t> FindColumns(const CsvColumns& columns,
                                          const std::vector<std::string>& header,
                                          const std::string& place) {
  double number = 0.0;
  if (ParseWhole(std::string_view(header[0]).substr(0, header[0].find(' ')), &number)) {
    const bool is_all_numbers = ParseNumbers(fmt::format("{}", fmt::join(header, " "))).has_value();
    throw InputError(
        fmt::format("{}: has no header, but '{}'; expected the names of the columns, {}{}", place,
                    fmt::join(header, ","), fmt::join(columns.required, ","),
                    is_all_numbers ? columns.rows_of_numbers : ""));
  }
  std::map<std::string, size_t> positions;
  std::vector<std::string> found;
  for (size_t i = 0; i < header.size(); ++i) {
    std::string name = LowerCase(header[i]);
    std::ranges::replace(name, ' ', '_');
    found.push_back(name);
    const auto has_name = [&](const std::vector<std::string>& names) {
      return std::ranges::find(names, name) != names.end();
    };
    const bool is_read = has_name(columns.required) || has_name(columns.optional);
    if (!is_read || positions.emplace(name, i).second) continue;
    throw InputError(fmt::format("{}: column '{}' is twice; expected each of {} once", place, name,
                                 fmt::join(columns.required, ",")));
  }
  std::vector<std::string> missing = columns.required;
  std::erase_if(missing, [&](const std::string& name) { return positions.contains(name); });
  if (missing.empty()) return positions;
  throw InputError(fmt::format("{}: {} missing; expected columns {}{}", place,
                               fmt::join(missing, ","), fmt::join(columns.required, ","),
                               columns.missing ? columns.missing(found) : ""));
}

}  // namespace

void ForEachCsvRow(const std::filesystem::path& path, const CsvColumns& columns,
                   const std::function<void(const CsvRow&)>& use) {
  const std::string text = ReadWholeFile(path);
  // Tabs at both ends of a line separate fields, which may be empty.
  const std::vector<TextLine> lines = LinesWithout(" \r", text, path.string());
  if (const std::string kind = FileKind(text); !kind.empty()) {
    throw InputError(fmt::format("{}: is {}; expected a table in CSV, with columns {}{}",
                                 path.string(), kind, fmt::join(columns.required, ","),
                                 columns.other_kind));
  }
  if (lines.empty()) {
    throw InputError(fmt::format("{}: is empty; expected a header {}", path.string(),
                                 fmt::join(columns.required, ",")));
  }
  const std::string& first = lines[0].text;
  char separator = ',';  // or, where it is more frequent in the header, semicolon or tab
  for (const char other : {';', '\t'}) {
    if (std::ranges::count(first, other) > std::ranges::count(first, separator)) separator = other;
  }
  const auto header = SplitCsvLine(lines[0].text, separator, lines[0].place);
  const auto positions = FindColumns(columns, header, lines[0].place);
  for (size_t i = 1; i < lines.size(); ++i) {
    const auto fields = SplitCsvLine(lines[i].text, separator, lines[i].place);
    if (fields.size() != header.size()) {
      throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has",
                                   lines[i].place, fields.size(), header.size()));
    }
    CsvRow row{lines[i].place, lines[0].place, {}};
    for (const auto& [column, position] : positions) row.fields[column] = fields[position];
    use(row);
  }
}

}  // namespace soslam
