// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/json_entry.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {

using nlohmann::json;

namespace {

// A value for an error message, truncated.
std::string Quoted(const json& value) {
  constexpr size_t kLongest = 100;
  const std::string text = value.dump();
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

}  // namespace

std::vector<JsonEntry> ListEntries(const json& list, const std::string& place) {
  std::vector<JsonEntry> entries;
  for (size_t i = 0; i < list.size(); ++i) {
    entries.emplace_back(list[i], fmt::format("{}/{}", place, i));
  }
  return entries;
}

JsonEntry::JsonEntry(const json& fields, std::string place)
    : fields_(fields), place_(std::move(place)) {
  if (!fields.is_object()) throw InputError(place_ + ": is not an object");
}

const json& JsonEntry::Field(const char* name) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) throw InputError(fmt::format("{}: {} is missing", place_, name));
  return *found;
}

const json& JsonEntry::List(const char* name) const {
  if (!Field(name).is_array()) Refuse(name, "a list");
  return Field(name);
}

int JsonEntry::Integer(const char* name) const {
  constexpr std::int64_t kMax = std::numeric_limits<int>::max();
  const json& field = Field(name);
  if (!field.is_number_integer() || field.get<double>() < -kMax || field.get<double>() > kMax) {
    Refuse(name, "an integer");
  }
  return field.get<int>();
}

double JsonEntry::Real(const char* name) const {
  const json& field = Field(name);
  if (!field.is_number()) Refuse(name, "a number");
  return field.get<double>();
}

double JsonEntry::Positive(const char* name) const {
  if (!(Real(name) > 0.0)) Refuse(name, "a number above 0");
  return Real(name);
}

std::vector<double> JsonEntry::Reals(const char* name) const {
  const json& list = List(name);
  for (const json& element : list) {
    if (!element.is_number()) Refuse(name, "a list of numbers");
  }
  return list.get<std::vector<double>>();
}

bool JsonEntry::Flag(const char* name, bool default_value) const {
  if (!Has(name)) return default_value;
  if (!Field(name).is_boolean()) Refuse(name, "true or false");
  return Field(name).get<bool>();
}

std::string JsonEntry::Text(const char* name) const {
  const json& field = Field(name);
  std::string text = field.is_string() ? field.get<std::string>() : "";
  if (text.empty()) Refuse(name, "a text");
  if (text.find('\0') != text.npos) Refuse(name, "a text without a zero byte");
  return text;
}

void JsonEntry::Refuse(const char* name, const std::string& expected) const {
  throw InputError(
      fmt::format("{}: {} is {}; expected {}", place_, name, Quoted(Field(name)), expected));
}

void JsonEntry::RefuseUnknownKeys(const KnownKeys& known) const {
  for (const auto& field : fields_.items()) {
    const std::string& key = field.key();
    if (std::ranges::find(known.keys, key) != known.keys.end()) continue;
    const auto meant = std::ranges::find_if(known.hints, [&](const KeyHint& hint) {
      return std::ranges::find(hint.keys, key) != hint.keys.end();
    });
    const auto likely = LikelyMeant(key, {known.keys.begin(), known.keys.end()});
    throw InputError(fmt::format("{}: unknown key {}; expected some of {}{}", place_, Quoted(key),
                                 fmt::join(known.keys, ", "),
                                 meant != known.hints.end() ? fmt::format("; {}", meant->instead)
                                 : likely ? fmt::format("; did you mean \"{}\"?", *likely)
                                          : ""));
  }
}

}  // namespace soslam
