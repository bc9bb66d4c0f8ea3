// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/text_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/run_log.h"

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

template <typename Number>
bool ParseWhole(std::string_view text, Number* number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *number);
  return error == std::errc() && stop == end;
}

}  // namespace

std::vector<TextLine> ReadTextLines(const std::filesystem::path& path) {
  NoteInput(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream || IsFolder(path)) {
    throw InputError(path.string() + ": cannot be read; expected a text file");
  }
  return TextLines(stream, path.string());
}

std::vector<TextLine> TextLines(std::istream& stream, const std::string& name) {
  std::vector<TextLine> lines;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    const std::string_view text = Trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    lines.push_back({fmt::format("{}:{}", name, number), std::string(text)});
    if (!IsUtf8(line) || line.find('\0') != line.npos) {
      throw InputError(lines.back().place + ": is not UTF-8 text");
    }
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
    throw InputError(fmt::format("{}: {} is '{}'; expected a finite number", place, field, text));
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
