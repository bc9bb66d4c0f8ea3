// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_findings.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/one_line.h"

namespace soslam {

void ReportFindings(const std::string& stage, const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    fmt::print(stderr, "soslam-{}: {}: {}\n", stage,
               kSeverityNames[static_cast<size_t>(finding.severity)], OneLine(InWords(finding)));
  }
}

}  // namespace soslam
