// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/finding.h"

#include <fmt/format.h>

#include <algorithm>

namespace soslam {

std::string InWords(const Finding& finding) {
  return fmt::format("{}; expected {}; likely cause: {}; remedy: {}", finding.found,
                     finding.expected, finding.cause, finding.remedy);
}

std::vector<Finding> WorstFirst(std::vector<Finding> findings) {
  std::vector<Finding> once;
  for (Finding& finding : findings) {
    if (std::ranges::find(once, finding) == once.end()) once.push_back(std::move(finding));
  }
  std::ranges::stable_sort(once, std::ranges::greater(), &Finding::severity);
  return once;
}

}  // namespace soslam
