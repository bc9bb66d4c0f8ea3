// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
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

}  // namespace soslam
