// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <numeric>
#include <sstream>
#include <utility>

namespace soslam {
namespace {

// Levenshtein distance: number of letters to insert, remove or replace.
size_t Misspellings(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t k = 0; k < b.size(); ++k) {
      const size_t changed = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({row[k] + 1, diagonal + 1, changed});
    }
  }
  return row.back();
}

}  // namespace

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string OneLine(const std::string& message) {
  const std::string text = message.substr(0, message.find_last_not_of('\n') + 1);
  std::string line;
  for (const char character : text) {
    const bool is_control = static_cast<unsigned char>(character) < 0x20 || character == 0x7F;
    if (character == '\n') {
      line += ' ';
    } else if (is_control) {
      line += fmt::format("\\x{:02x}", static_cast<unsigned char>(character));
    } else {
      line += character;
    }
  }
  // A long line keeps only its begin and its end, cut between characters of UTF-8.
  constexpr size_t kMaxHalf = 1000;
  if (line.size() <= 2 * kMaxHalf) return line;
  const auto is_inside_character = [&](size_t i) { return (line[i] & 0xC0) == 0x80; };
  size_t begin = kMaxHalf;
  size_t end = line.size() - kMaxHalf;
  while (begin > 0 && is_inside_character(begin)) --begin;
  while (end < line.size() && is_inside_character(end)) ++end;
  return line.substr(0, begin) + " ... " + line.substr(end);
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

std::vector<std::string_view> SplitFields(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  for (size_t end = text.find(separator); end != text.npos; end = text.find(separator)) {
    fields.push_back(Trimmed(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  fields.push_back(Trimmed(text));
  return fields;
}

size_t CountCharacters(const std::string& text) {
  // Continuation bytes do not count.
  return static_cast<size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string Wrapped(const std::string& text, size_t width, size_t indent) {
  std::string wrapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!wrapped.empty()) wrapped += '\n' + std::string(indent, ' ');
    std::istringstream words(line);
    size_t length = 0;
    for (std::string word; words >> word; length += CountCharacters(word)) {
      if (length > 0 && length + 1 + CountCharacters(word) > width) {
        wrapped += '\n' + std::string(indent, ' ');
        length = 0;
      } else if (length > 0) {
        wrapped += ' ';
        ++length;
      }
      wrapped += word;
    }
  }
  return wrapped;
}

std::string NamesInWords(const std::vector<std::string>& names, size_t most) {
  const size_t count = std::min(most, names.size());
  std::string text = fmt::format(
      "{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count), ", "));
  if (names.size() > count) text += fmt::format(" and {} more", names.size() - count);
  return text;
}

std::string Counted(size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::optional<std::string> LikelyMeant(std::string_view text,
                                       const std::vector<std::string>& known) {
  constexpr size_t kLongest = 64, kMost = 2;
  if (text.size() > kLongest) return std::nullopt;
  std::optional<std::string> likely;
  size_t fewest = kMost + 1;
  for (const std::string& name : known) {
    const size_t misspellings = Misspellings(text, name);
    if (misspellings >= fewest || 2 * misspellings >= name.size()) continue;
    fewest = misspellings;
    likely = name;
  }
  return likely;
}

std::string CountsInWords(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater{}, &std::pair<std::string, int>::second);
  std::vector<std::string> words;
  for (const auto& [name, count] : sorted) words.push_back(fmt::format("{} {}", count, name));
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace soslam
