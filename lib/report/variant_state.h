// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "report/results_tree.h"

namespace soslam {

// The reason why the variant's folder does not show the planned results: "failed: refine: exit code
// 3: ..." or "incomplete: refine has not run"; empty if it does, and for folders without
// stages.txt.
std::string WhyUnfinished(const VariantResult& variant);

// True if this stage contributed to the results in the variant's folder: by its list of stages or,
// without one, by the stage's file in it.
bool ShowsStage(const VariantResult& variant, const std::string& stage, const std::string& file);

}  // namespace soslam
