// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "stage/stage_files.h"

namespace soslam {

struct PagesOptions {
  void Describe(OptionVisitor&) {}
};

// Writes <results>/<dataset>/report.html for each dataset with results that can be shown, and
// <results>/report.html with all of them, each of at most kMaxPageBytes. Files: "results". Images
// come from the datasets, where these still are. What cannot be read, or was planned and is not
// complete, is named on the pages and on stderr. Throws NothingUsableError when there is nothing to
// show.
void RunPages(const PagesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
