// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace soslam {

enum class Severity {
  kWarning,  // may be right, and a person has to decide
  kError,    // cannot be right
};
inline constexpr std::array kSeverityNames = {"warning", "error"};

// What a look at data or at a result found that does not fit what it should be.
struct Finding {
  std::string check;  // name of the check: "camera_size"
  Severity severity = Severity::kWarning;
  std::string found;     // with its numbers
  std::string expected;  // of data that are as they should be
  std::string cause;     // the likely one
  std::string remedy;    // what to do

  bool operator==(const Finding&) const = default;
};

// One sentence for a person, without name and severity.
std::string InWords(const Finding& finding);

// Errors first; otherwise in the order that they had, each once.
std::vector<Finding> WorstFirst(std::vector<Finding> findings);

}  // namespace soslam
