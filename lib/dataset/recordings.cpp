// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

// Throws SettingsError for an invalid setting.
[[noreturn]] void Refuse(const std::string& option, std::string_view found, const char* expected) {
  throw SettingsError(fmt::format("{}: found '{}'; expected {}", option, found, expected));
}

int ParseRecording(const std::string& option, std::string_view text) {
  constexpr const char* kExpected = "the number of a recording, or two as in 0003-0005";
  const bool is_number = !text.empty() && std::all_of(text.begin(), text.end(),
                                                      [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number || text.size() > 9) Refuse(option, text, kExpected);
  return ParseInteger(text, option, "recording");
}

RecordingRange ParseRange(const std::string& option, std::string_view text) {
  const size_t dash = text.find('-');
  const int first = ParseRecording(option, text.substr(0, dash));
  if (dash == std::string_view::npos) return {first, first};
  const int last = ParseRecording(option, text.substr(dash + 1));
  if (last < first) Refuse(option, text, "the lower number first");
  return {first, last};
}

}  // namespace

std::vector<RecordingRange> ParseRecordings(const std::string& option, std::string_view text) {
  std::vector<RecordingRange> ranges;
  for (const std::string_view word : SplitWords(text)) ranges.push_back(ParseRange(option, word));
  return ranges;
}

RecordingValues::RecordingValues(const std::string& option, const std::string& text)
    : option_(option) {
  const auto words = SplitWords(text);
  for (const std::string_view word : words) {
    const size_t colon = word.find(':');
    if (colon != std::string_view::npos) {
      entries_.push_back(
          {ParseRange(option, word.substr(0, colon)), std::string(word.substr(colon + 1))});
    } else if (words.size() == 1) {
      entries_.push_back({{0, std::numeric_limits<int>::max()}, std::string(word)});
    } else {
      Refuse(option, word, "a recording, a colon and its value, as in 0000-0013:1");
    }
  }
}

const std::string& RecordingValues::Of(int recording) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.range.Contains(recording);
  });
  if (found == entries_.end()) {
    throw SettingsError(fmt::format("{}: says nothing about recording {:04d}; expected a value",
                                    option_, recording));
  }
  return found->value;
}

double RecordingValues::PositiveOf(int recording) const {
  const std::string& text = Of(recording);
  double value = 0.0;
  try {
    value = ParseReal(text, option_, "value");
  } catch (const InputError&) {
    Refuse(option_, text, "a number above 0");
  }
  if (!(value > 0.0)) Refuse(option_, text, "a number above 0");
  return value;
}

}  // namespace soslam
