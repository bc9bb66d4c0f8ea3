// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "stage/stage_files.h"

namespace soslam {

struct ReproduceOptions {
  void Describe(OptionVisitor&) {}
};

// Runs once more what made the variants in folder "results", as their run.json say, with the
// programs in folder "executables", into a folder beside "results" that is removed at the end.
// Prints which artefacts come out the same, and the first place at which others differ. Datasets
// are in folder "data_root"; without it they are where they were. The exit code: kFindings when an
// artefact differs or could not be made again. Throws as FindRuns; SettingsError when nothing can
// be written beside "results".
int RunReproduce(const ReproduceOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
