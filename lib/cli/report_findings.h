// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/finding.h"

namespace soslam {

// Prints findings on stderr, one per line.
void ReportFindings(const std::string& stage, const std::vector<Finding>& findings);

}  // namespace soslam
