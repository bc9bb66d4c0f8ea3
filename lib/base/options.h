// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace soslam {

// The one table of options. Every options struct has
//
//   void Describe(OptionVisitor& visit) { visit.Real("border_px", &border_px, {0, 1e4}, "doc"); ...
//   }
//
// and everything else follows from it: reading and writing JSON, the command line, --help, the
// JSON schema of the settings. The unit of a number is the end of its name (_px, _deg, _m, ...);
// other numbers have none. A doc names the equation of the paper that an option stands for.
class OptionVisitor {
 public:
  struct Range {
    double min;
    double max;
  };

  virtual ~OptionVisitor() = default;

  // An option of the same table with one of these values; flags have "true" and "false".
  struct Condition {
    const char* option;
    std::vector<std::string> values;
  };
  // Conditions of which one has to hold.
  using Conditions = std::vector<Condition>;

  // Options that follow are listed under this heading, up to the next one; a heading may come back.
  virtual void Group(const char* /*heading*/) {}

  // Options that `describe` visits have an effect only under these conditions. Calls may be nested.
  virtual void OnlyWhere(const Conditions& /*conditions*/, const std::function<void()>& describe) {
    describe();
  }

  virtual void Real(const char* name, double* value, Range range, const char* doc) = 0;
  virtual void Integer(const char* name, int* value, Range range, const char* doc) = 0;
  virtual void Flag(const char* name, bool* value, const char* doc) = 0;
  virtual void Text(const char* name, std::string* value, const char* doc) = 0;

  // An enumeration whose values 0..n-1 have these names.
  template <typename Enum>
  void Choice(const char* name, Enum* value, std::span<const char* const> names, const char* doc) {
    static_assert(std::is_enum_v<Enum>);
    int index = static_cast<int>(*value);
    ChoiceIndex(name, &index, names, doc);
    *value = static_cast<Enum>(index);
  }

 protected:
  virtual void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                           const char* doc) = 0;
};

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
