// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "stage/stage_files.h"

namespace soslam {

struct PagesOptions {
  void Describe(OptionVisitor&) {}
};

// Writes <results>/<dataset>/report.html for each dataset with results, and <results>/report.html
// with all of them. Files: "results". Images come from the datasets, where these still are. Throws
// NothingUsableError when no dataset has results.
void RunPages(const PagesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
