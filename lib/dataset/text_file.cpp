// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/run_log.h"
#include "base/text_encoding.h"

namespace soslam {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

// Names and labels end up in JSON, which has to be UTF-8.
bool IsUtf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

std::string ReadWhole(const std::filesystem::path& path) {
  NoteInput(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream || IsFolder(path)) {
    throw InputError(path.string() + ": cannot be read; expected a text file");
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

template <typename Number>
bool ParseWhole(std::string_view text, Number* number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *number);
  return error == std::errc() && stop == end;
}

// Whether a decimal point in place of the only comma would make it a number.
bool HasDecimalComma(std::string_view text) {
  std::string with_point(text);
  const size_t comma = with_point.find(',');
  if (comma == with_point.npos) return false;
  with_point[comma] = '.';
  double number = 0.0;
  return ParseWhole(with_point, &number);
}

}  // namespace

std::vector<TextLine> ReadTextLines(const std::filesystem::path& path) {
  return TextLines(ReadWhole(path), path.string());
}

std::vector<TextLine> TextLines(const std::string& text, const std::string& name) {
  std::vector<TextLine> lines;
  for (TextLine& line : RawLines(text, name)) {
    const std::string_view trimmed = Trimmed(line.text);
    if (trimmed.empty() || trimmed.front() == '#') continue;
    lines.push_back({std::move(line.place), std::string(trimmed)});
    if (!IsUtf8(line.text) || line.text.find('\0') != line.text.npos) {
      throw InputError(lines.back().place + ": is not UTF-8 text");
    }
  }
  return lines;
}

std::vector<TextLine> ReadRawLines(const std::filesystem::path& path) {
  return RawLines(ReadWhole(path), path.string());
}

std::vector<TextLine> RawLines(const std::string& text, const std::string& name) {
  if (!text.empty()) CheckIsNotUtf16(static_cast<unsigned char>(text.front()), name);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  const char line_end = rest.find('\n') == rest.npos ? '\r' : '\n';
  std::vector<TextLine> lines;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find(line_end));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const size_t end = line.find_last_not_of('\r');
    lines.push_back({fmt::format("{}:{}", name, lines.size() + 1),
                     std::string(line.substr(0, end == line.npos ? 0 : end + 1))});
  }
  return lines;
}

std::string_view Trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> SplitWords(std::string_view text) {
  std::vector<std::string_view> words;
  for (text = Trimmed(text); !text.empty(); text = Trimmed(text)) {
    words.push_back(text.substr(0, text.find_first_of(kBlanks)));
    text.remove_prefix(words.back().size());
  }
  return words;
}

std::vector<std::string_view> SplitFields(std::string_view text) {
  std::vector<std::string_view> fields;
  for (size_t comma = text.find(','); comma != std::string_view::npos; comma = text.find(',')) {
    fields.push_back(Trimmed(text.substr(0, comma)));
    text.remove_prefix(comma + 1);
  }
  fields.push_back(Trimmed(text));
  return fields;
}

double ParseReal(std::string_view text, const std::string& place, const std::string& field) {
  double number = 0.0;
  if (!ParseWhole(text, &number) || !std::isfinite(number)) {
    throw InputError(fmt::format("{}: {} is '{}'; expected a finite number{}", place, field, text,
                                 HasDecimalComma(text) ? ", with a decimal point" : ""));
  }
  return number;
}

int ParseInteger(std::string_view text, const std::string& place, const std::string& field) {
  int number = 0;
  if (!ParseWhole(text, &number)) {
    throw InputError(fmt::format("{}: {} is '{}'; expected an integer", place, field, text));
  }
  return number;
}

}  // namespace soslam
