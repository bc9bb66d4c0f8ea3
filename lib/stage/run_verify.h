// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "base/options.h"
#include "cli/stage_files.h"
#include "workflow/recorded_runs.h"

namespace soslam {

struct VerifyOptions {
  void Describe(OptionVisitor&) {}
};

// The runs in folder "results", of datasets in folder "data_root"; without it the datasets are at
// their recorded place. Throws as FindRuns of the folders.
std::vector<DatasetRuns> FindRuns(const StageFiles& files);

// soslam-verify: prints which files of folder "results" differ from their run.json, one line each,
// and a table of all datasets. The exit code is kFindings when there is any. Throws as FindRuns.
int RunVerify(const VerifyOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
