// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "soslam/base/text.h"

namespace soslam {

// True for UTF-8, which names and labels have to be: they are written to JSON.
bool IsUtf8(const std::string& text);

// The bytes of a file. Throws InputError, naming the `kind` of file that was expected ("text
// file"), when it cannot be read, is not a regular file, or is larger than 1 GiB.
std::string ReadWholeFile(const std::filesystem::path& path, const char* kind = "text file");

// One line of a text file, without its line ending.
struct TextLine {
  std::string place;  // "<file>:<line number from 1>", for error messages
  std::string text;
};

// Reads the lines of a UTF-8 text file without blank lines and comments (first character #),
// trimmed of blanks. A byte order mark is dropped. Lines end with a line feed, with or without
// carriage returns, or with a carriage return in a text without line feeds. Throws InputError when
// the file cannot be read, is not a regular file, is larger than 1 GiB, or is not UTF-8.
std::vector<TextLine> ReadTextLines(const std::filesystem::path& path);
// The result of `parse` for each line of ReadTextLines.
template <typename Parse>
auto ParseTextLines(const std::filesystem::path& path, const Parse& parse) {
  std::vector<std::invoke_result_t<Parse, const TextLine&>> items;
  for (const TextLine& line : ReadTextLines(path)) items.push_back(parse(line));
  return items;
}

// ReadTextLines for a text that is not a file of its own; `name` stands for it in error messages.
std::vector<TextLine> TextLines(const std::string& text, const std::string& name);

// All lines unchanged, including blank ones and comments; at most 20 million. Comments need not be
// UTF-8.
std::vector<TextLine> RawLines(const std::string& text, const std::string& name);

// Parses all of `text` as a number, independent of the locale. Throws InputError, naming place and
// field, for anything else; a real number must be finite.
double ParseReal(std::string_view text, const std::string& place, const std::string& field);
int ParseInteger(std::string_view text, const std::string& place, const std::string& field);

// The numbers of a setting; none when one of its words is not a number.
std::optional<std::vector<double>> ParseNumbers(std::string_view text);
// The finite number that a text consists of; none for other texts.
std::optional<double> ParseNumber(std::string_view text);
// Throws SettingsError for the text of an option.
[[noreturn]] void RefuseSetting(const std::string& option, std::string_view found,
                                const std::string& expected);

// ParseReal for the first words of a line, one per field.
template <size_t kCount>
std::array<double, kCount> ParseReals(std::span<const std::string_view> words,
                                      const std::string& place,
                                      const std::array<const char*, kCount>& fields) {
  std::array<double, kCount> numbers;
  for (size_t i = 0; i < kCount; ++i) numbers[i] = ParseReal(words[i], place, fields[i]);
  return numbers;
}

// The columns of a table that are read. Optional ones may be absent.
struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional = {};
  // Ends of the messages about a table of numbers without header, about a header (names in lower
  // case) in which columns are missing, and about a file of another kind.
  std::string rows_of_numbers = {};
  std::function<std::string(const std::vector<std::string>& header)> missing = {};
  std::string other_kind = {};
};

struct CsvRow {
  std::string place;  // "<file>:<line>", for error messages
  std::string place_of_header;
  std::map<std::string, std::string> fields;  // trimmed, by the names of the columns

  double Real(const std::string& column) const {
    return ParseReal(fields.at(column), place, column);
  }
};

// Reads a table in CSV whose first line names its columns, in any order and among others; names are
// case-insensitive, with blanks equal to underscores. The separator is the most frequent one of
// comma, semicolon and tab in that line. A field that begins with a quote ends with one; two quotes
// within it stand for one. Throws InputError, naming the line, for a first line that begins with a
// number, columns that are missing, a column that is there twice, another number of fields than in
// the first line, and quotes that are not closed.
void ForEachCsvRow(const std::filesystem::path& path, const CsvColumns& columns,
                   const std::function<void(const CsvRow&)>& use);

}  // namespace soslam
