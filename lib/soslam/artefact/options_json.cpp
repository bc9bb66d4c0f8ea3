// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/options_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam::internal {
namespace {

class Reader : public OptionVisitor {
 public:
  Reader(const nlohmann::json& values, const std::string& where) : values_(values), where_(where) {
    if (!values.is_object()) {
      throw SettingsError(where + ": expected an object of settings, found " + values.dump());
    }
  }

  void Real(const char* name, double* value, Range range, const char*) override {
    if (const auto* found = Find(name, &nlohmann::json::is_number, "a number")) {
      *value = InRange(name, found->get<double>(), range);
    }
  }
  void Integer(const char* name, int* value, Range range, const char*) override {
    if (const auto* found = Find(name, &nlohmann::json::is_number, "an integer")) {
      // 5.0 is an integer too, as in JSON Schema.
      const auto number = found->get<double>();
      if (std::trunc(number) != number) Refuse(name, *found, "an integer");
      *value = static_cast<int>(InRange(name, number, range));
    }
  }
  void Flag(const char* name, bool* value, const char*) override {
    const auto* found = Find(name, &nlohmann::json::is_boolean, "true or false");
    if (found != nullptr) found->get_to(*value);
  }
  void Text(const char* name, std::string* value, const char*) override {
    const auto* found = Find(name, &nlohmann::json::is_string, "a string");
    if (found != nullptr) found->get_to(*value);
  }

  void RefuseUnknown() const {
    for (const auto& item : values_.items()) {
      if (!known_.contains(item.key())) {
        const auto meant = LikelyMeant(item.key(), {known_.begin(), known_.end()});
        throw SettingsError(fmt::format("{}: unknown setting '{}'; {}known are {}", where_,
                                        item.key(), meant ? "did you mean '" + *meant + "'? " : "",
                                        fmt::join(known_, ", ")));
      }
    }
  }

 protected:
  void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                   const char*) override {
    if (const auto* found = Find(name, nullptr, "")) {
      const auto choice = std::ranges::find(names, *found);
      if (choice == names.end()) {
        Refuse(name, *found, fmt::format("one of {}", fmt::join(names, " | ")));
      }
      *index = static_cast<int>(choice - names.begin());
    }
  }

 private:
  using IsOfType = bool (nlohmann::json::*)() const noexcept;

  // The value of an option, null if none is given. Refuses another type than the `expected` one.
  const nlohmann::json* Find(const char* name, IsOfType is_of_type, const char* expected) {
    known_.insert(name);
    const auto found = values_.find(name);
    if (found == values_.end()) return nullptr;
    if (is_of_type != nullptr && !((*found).*is_of_type)()) Refuse(name, *found, expected);
    return &*found;
  }
  [[noreturn]] void Refuse(const char* name, const nlohmann::json& found,
                           const std::string& expected) const {
    throw SettingsError(
        fmt::format("{}: setting '{}' is {}; expected {}", where_, name, found.dump(), expected));
  }
  double InRange(const char* name, double value, Range range) const {
    if (!(value >= range.min && value <= range.max)) {
      Refuse(name, value, fmt::format("a value from {} to {}", range.min, range.max));
    }
    return value;
  }

  const nlohmann::json& values_;
  std::string where_;
  std::set<std::string> known_;
};

// Suffix of an option's name and the unit that it stands for.
struct UnitSuffix {
  const char* suffix;
  const char* unit;
};
constexpr UnitSuffix kUnitSuffixes[] = {{"_px", "px"}, {"_deg", "deg"},    {"_m", "m"},
                                        {"_s", "s"},   {"_deg2", "deg^2"}, {"_dm4", "dm^4"}};

std::string FindUnit(const std::string& name) {
  for (const auto& [suffix, unit] : kUnitSuffixes) {
    if (name.ends_with(suffix)) return unit;
  }
  return "";
}

class Lister : public OptionVisitor {
 public:
  std::vector<OptionRow> rows;

  void Group(const char* heading) override { group_ = heading; }
  void OnlyWhere(const Conditions& conditions, const std::function<void()>& describe) override {
    only_where_.push_back(conditions);
    describe();
    only_where_.pop_back();
  }
  void Real(const char* name, double* value, Range range, const char* doc) override {
    Add(name, "number", *value, doc).range = range;
  }
  void Integer(const char* name, int* value, Range range, const char* doc) override {
    Add(name, "integer", *value, doc).range = range;
  }
  void Flag(const char* name, bool* value, const char* doc) override {
    Add(name, "boolean", *value, doc);
  }
  void Text(const char* name, std::string* value, const char* doc) override {
    Add(name, "string", *value, doc);
  }

 protected:
  void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                   const char* doc) override {
    OptionRow& row = Add(name, "string", names[*index], doc);
    row.choices.assign(names.begin(), names.end());
  }

 private:
  OptionRow& Add(const char* name, const char* type, const nlohmann::json& value, const char* doc) {
    return rows.emplace_back(
        OptionRow{name, type, value, {}, {}, FindUnit(name), group_, doc, only_where_});
  }

  std::string group_;
  std::vector<Conditions> only_where_;
};

}  // namespace

nlohmann::json ToJson(const DescribeFunction& describe) {
  nlohmann::json values = nlohmann::json::object();
  for (const OptionRow& row : Rows(describe)) values[row.name] = row.default_value;
  return values;
}

void FromJson(const DescribeFunction& describe, const nlohmann::json& values,
              const std::string& where) {
  Reader reader(values, where);
  describe(reader);
  reader.RefuseUnknown();
}

std::vector<OptionRow> Rows(const DescribeFunction& describe) {
  Lister lister;
  describe(lister);
  return lister.rows;
}

}  // namespace soslam::internal

namespace soslam {

nlohmann::ordered_json SettingsSchema(const std::vector<OptionRow>& rows,
                                      const std::string& title) {
  nlohmann::ordered_json properties = nlohmann::ordered_json::object();
  for (const OptionRow& row : rows) {
    nlohmann::ordered_json& property = properties[row.name];
    property = {{"type", row.type}, {"default", row.default_value}};
    if (row.range) {
      property["minimum"] = row.range->min;
      property["maximum"] = row.range->max;
    }
    if (!row.choices.empty()) property["enum"] = row.choices;
    if (!row.unit.empty()) property["unit"] = row.unit;
    if (!row.group.empty()) property["group"] = row.group;
    for (const OptionVisitor::Conditions& conditions : row.only_where) {
      property["only_where"].push_back(InWords(conditions));
    }
    property["description"] = row.doc;
  }
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", title},
          {"type", "object"},
          {"properties", properties},
          {"additionalProperties", false}};
}

std::string InWords(const OptionVisitor::Conditions& conditions) {
  std::vector<std::string> words;
  for (const auto& [option, values] : conditions) {
    words.push_back(fmt::format("{} = {}", option, fmt::join(values, " or ")));
  }
  return fmt::format("{}", fmt::join(words, " or "));
}

OptionVisitor::Conditions UnmetConditions(const std::vector<OptionRow>& rows,
                                          const nlohmann::json& values, const std::string& name) {
  const auto holds = [&](const OptionVisitor::Condition& condition) {
    const nlohmann::json& value = values.at(condition.option);
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    return std::ranges::find(condition.values, text) != condition.values.end() &&
           UnmetConditions(rows, values, condition.option).empty();
  };
  const auto row = std::ranges::find(rows, name, &OptionRow::name);
  if (row == rows.end()) return {};
  const auto unmet = std::ranges::find_if_not(row->only_where, [&](const auto& conditions) {
    return std::ranges::any_of(conditions, holds);
  });
  return unmet == row->only_where.end() ? OptionVisitor::Conditions() : *unmet;
}

std::vector<std::string> SettingChanges(const nlohmann::json& before, const nlohmann::json& now) {
  const auto text = [](const nlohmann::json& settings, const std::string& name) {
    return settings.contains(name) ? settings.at(name).dump() : std::string("absent");
  };
  nlohmann::json names = before;
  names.update(now);
  std::vector<std::string> changes;
  for (const auto& [name, value] : names.items()) {
    const std::string old_text = text(before, name);
    const std::string new_text = text(now, name);
    if (old_text != new_text)
      changes.push_back(fmt::format("{}: {} -> {}", name, old_text, new_text));
  }
  return changes;
}

}  // namespace soslam
