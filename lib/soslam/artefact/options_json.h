// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/options.h"

namespace soslam {

// One option, for --help and the settings schema.
struct OptionRow {
  std::string name;
  std::string type;  // as in JSON schemas: "number", "integer", "boolean", "string"
  nlohmann::json default_value;
  std::optional<OptionVisitor::Range> range;  // of numbers only
  std::vector<std::string> choices;           // of enumerations only
  std::string unit;                           // "px"; empty for none
  std::string group;                          // heading; empty before the first one
  std::string doc;
  std::vector<OptionVisitor::Conditions> only_where;  // all have to hold for it to have an effect
};

// "method = yaw_sweep or multi_view"
std::string InWords(const OptionVisitor::Conditions& conditions);

// The first conditions under which an option would have an effect that do not hold for these values
// of all options; empty if it has one, or is not in the table.
OptionVisitor::Conditions UnmetConditions(const std::vector<OptionRow>& rows,
                                          const nlohmann::json& values, const std::string& name);

// The JSON schema (draft 7) of a settings file with these options: it takes what OptionsFromJson
// accepts. Units, groups and conditions are stored as keywords "unit", "group" and "only_where".
nlohmann::ordered_json SettingsSchema(const std::vector<OptionRow>& rows, const std::string& title);

// Differences between two sets of settings: "yaw_step_deg: 2.0 -> 5.0".
std::vector<std::string> SettingChanges(const nlohmann::json& before, const nlohmann::json& now);

namespace internal {

// Calls the Describe of a struct, so that the visitors live in one .cpp.
using DescribeFunction = std::function<void(OptionVisitor&)>;

nlohmann::json ToJson(const DescribeFunction& describe);
void FromJson(const DescribeFunction& describe, const nlohmann::json& values,
              const std::string& where);
std::vector<OptionRow> Rows(const DescribeFunction& describe);

}  // namespace internal

// All options with their current values.
template <typename Options>
nlohmann::json OptionsToJson(Options options) {
  return internal::ToJson([&](OptionVisitor& visit) { options.Describe(visit); });
}

// Overwrites the options named in `values`; the others keep their value. Throws SettingsError,
// naming `where` and the option, for an unknown name, a wrong type or a value out of range.
template <typename Options>
void OptionsFromJson(const nlohmann::json& values, const std::string& where, Options* options) {
  internal::FromJson([&](OptionVisitor& visit) { options->Describe(visit); }, values, where);
}

// The options in order of declaration.
template <typename Options>
std::vector<OptionRow> OptionRows() {
  Options options;
  return internal::Rows([&](OptionVisitor& visit) { options.Describe(visit); });
}

}  // namespace soslam
