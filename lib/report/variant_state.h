// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "report/results_tree.h"

namespace soslam {

// Why the variant's folder does not show what was planned: "failed: refine: exit code 3: ..." or
// "incomplete: refine has not run"; empty when it does, and of folders without stages.txt.
std::string WhyUnfinished(const VariantResult& variant);

// Whether what the variant's folder shows was made by this stage as well: as its list of stages
// says or, in folders without, the stage's file in it.
bool ShowsStage(const VariantResult& variant, const std::string& stage, const std::string& file);

}  // namespace soslam
