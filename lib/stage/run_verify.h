// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

// soslam-verify: prints which files of folder "results" differ from their run.json, one line each,
// and a table of all datasets. Datasets are in folder "data_root"; without it at their recorded
// place. The exit code is kFindings when there is any. Throws as FindRuns.
int RunVerify(const NoOptions& options, const StageFiles& files, int threads);

// soslam-reproduce: repeats the runs of the variants in folder "results", as recorded in their
// run.json, with the programs in folder "executables", into a folder beside "results" that is
// removed at the end. Prints which artefacts are identical, and the first difference in the others.
// Datasets are in folder "data_root"; without it at their recorded place. The exit code is
// kFindings when an artefact differs or could not be made again. Throws as FindRuns; SettingsError
// when nothing can be written beside "results".
int RunReproduce(const NoOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
