// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "base/options.h"
#include "provenance/recorded_runs.h"
#include "stage/stage_files.h"

namespace soslam {

struct VerifyOptions {
  void Describe(OptionVisitor&) {}
};

// The runs in folder "results", of datasets in folder "data_root"; without it they are where they
// were. Throws as FindRuns of the folders.
std::vector<DatasetRuns> FindRuns(const StageFiles& files);

// Prints which files of folder "results" no longer are what their run.json says, one line each, and
// a table of all datasets. The exit code: kFindings when there is any. Throws as FindRuns.
int RunVerify(const VerifyOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
