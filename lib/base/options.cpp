// SPDX-License-Identifier: BSD-3-Clause
#include "base/options.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/error.h"

namespace soslam::internal {
namespace {

std::string JoinNames(std::span<const char* const> names) {
  return fmt::format("{}", fmt::join(names, " | "));
}

class Writer : public OptionVisitor {
 public:
  nlohmann::json values = nlohmann::json::object();

  void Real(const char* name, double* value, Range, const char*) override { values[name] = *value; }
  void Integer(const char* name, int* value, Range, const char*) override { values[name] = *value; }
  void Flag(const char* name, bool* value, const char*) override { values[name] = *value; }
  void Text(const char* name, std::string* value, const char*) override { values[name] = *value; }

 protected:
  void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                   const char*) override {
    values[name] = names[static_cast<size_t>(*index)];
  }
};

class Reader : public OptionVisitor {
 public:
  Reader(const nlohmann::json& values, const std::string& where) : values_(values), where_(where) {
    if (!values.is_object()) {
      throw SettingsError(where + ": expected an object of settings, found " + values.dump());
    }
  }

  void Real(const char* name, double* value, Range range, const char*) override {
    if (const auto* found = Find(name)) {
      if (!found->is_number()) Refuse(name, *found, "a number");
      *value = InRange(name, found->get<double>(), range);
    }
  }
  void Integer(const char* name, int* value, Range range, const char*) override {
    if (const auto* found = Find(name)) {
      if (!found->is_number_integer()) Refuse(name, *found, "an integer");
      *value = static_cast<int>(InRange(name, found->get<double>(), range));
    }
  }
  void Flag(const char* name, bool* value, const char*) override {
    if (const auto* found = Find(name)) {
      if (!found->is_boolean()) Refuse(name, *found, "true or false");
      *value = found->get<bool>();
    }
  }
  void Text(const char* name, std::string* value, const char*) override {
    if (const auto* found = Find(name)) {
      if (!found->is_string()) Refuse(name, *found, "a string");
      *value = found->get<std::string>();
    }
  }

  void RefuseUnknown() const {
    for (const auto& item : values_.items()) {
      if (known_.count(item.key()) == 0) {
        throw SettingsError(fmt::format("{}: unknown setting '{}'; known are {}", where_,
                                        item.key(), fmt::join(known_, ", ")));
      }
    }
  }

 protected:
  void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                   const char*) override {
    if (const auto* found = Find(name)) {
      for (size_t i = 0; i < names.size(); ++i) {
        if (*found == names[i]) {
          *index = static_cast<int>(i);
          return;
        }
      }
      Refuse(name, *found, "one of " + JoinNames(names));
    }
  }

 private:
  const nlohmann::json* Find(const char* name) {
    known_.insert(name);
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : &*found;
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

class Lister : public OptionVisitor {
 public:
  std::vector<OptionRow> rows;

  void Real(const char* name, double* value, Range range, const char* doc) override {
    rows.push_back({name, "number", fmt::format("{}", *value), Domain(range), doc});
  }
  void Integer(const char* name, int* value, Range range, const char* doc) override {
    rows.push_back({name, "integer", fmt::format("{}", *value), Domain(range), doc});
  }
  void Flag(const char* name, bool* value, const char* doc) override {
    rows.push_back({name, "boolean", *value ? "true" : "false", "true | false", doc});
  }
  void Text(const char* name, std::string* value, const char* doc) override {
    rows.push_back({name, "string", '"' + *value + '"', "", doc});
  }

 protected:
  void ChoiceIndex(const char* name, int* index, std::span<const char* const> names,
                   const char* doc) override {
    rows.push_back({name, "string", names[static_cast<size_t>(*index)], JoinNames(names), doc});
  }

 private:
  static std::string Domain(Range range) { return fmt::format("{} to {}", range.min, range.max); }
};

}  // namespace

nlohmann::json ToJson(void* options, DescribeFunction describe) {
  Writer writer;
  describe(options, writer);
  return writer.values;
}

void FromJson(void* options, DescribeFunction describe, const nlohmann::json& values,
              const std::string& where) {
  Reader reader(values, where);
  describe(options, reader);
  reader.RefuseUnknown();
}

std::vector<OptionRow> Rows(void* options, DescribeFunction describe) {
  Lister lister;
  describe(options, lister);
  return lister.rows;
}

}  // namespace soslam::internal
