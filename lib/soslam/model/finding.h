// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace soslam {

enum class Severity {
  kWarning,  // may be right; a person has to decide
  kError,    // cannot be right
};
inline constexpr std::array kSeverityNames = {"warning", "error"};
inline constexpr const auto& NamesOf(Severity) { return kSeverityNames; }

// A violation found by a check of data or of a result.
struct Finding {
  std::string check;  // name of the check: "camera_size"
  Severity severity = Severity::kWarning;
  std::string found;     // what was found, with numbers
  std::string expected;  // what correct data would have
  std::string cause;     // the likely cause
  std::string remedy;    // what to do

  bool operator==(const Finding&) const = default;
};

template <typename Visitor>
void Describe(Visitor& visit, Finding& finding) {
  visit.Field("check", &finding.check, "name of the check");
  visit.Field("severity", &finding.severity, "error: cannot be right; warning: may be right");
  visit.Field("found", &finding.found, "what was found, with its numbers");
  visit.Field("expected", &finding.expected, "what data that are as they should be have");
  visit.Field("cause", &finding.cause, "the likely cause");
  visit.Field("remedy", &finding.remedy, "what to do");
}

// The finding as one sentence for a person, without name and severity.
std::string InWords(const Finding& finding);

// Findings without duplicates, errors first, otherwise in the given order.
std::vector<Finding> WorstFirst(std::vector<Finding> findings);

}  // namespace soslam
