// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "stage/stage_files.h"

namespace soslam {

// A table always shows everything there is, so that tables from different runs can be compared.
struct ReportOptions {
  void Describe(OptionVisitor&) {}
};

// Collects <dataset>/<variant>/metrics.json from folder "results" into one Markdown table per
// dataset, printed and written to file "output". The variants of the paper come first and always
// have a row; what is not there is "-". Throws NothingUsableError when there are no metrics at all,
// InputError for a metrics file that is not JSON or has something else where a number should be.
void RunReport(const ReportOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
