// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

struct PagesOptions {
  void Describe(OptionVisitor&) {}
};

// soslam-pages: writes <results>/<dataset>/report.html for each dataset with results to show, and
// <results>/report.html with all of them, each of at most kMaxPageBytes. Files: "results". Images
// are read from the datasets if these still exist. Results that are unreadable or planned but
// incomplete are listed on the pages and on stderr. Throws NothingUsableError when there is nothing
// to show.
void RunPages(const PagesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
