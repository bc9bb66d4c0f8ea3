// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/finding.h"

namespace soslam {

// Prints findings on stderr, a line each, for the person who runs a stage.
void ReportFindings(const std::string& stage, const std::vector<Finding>& findings);

}  // namespace soslam
