// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "dataset/import_options.h"

namespace soslam {

// soslam-import: reads the folder "dataset", writes the sequence artefact "output" and prints a
// one-line summary of how much is used. Errors as ImportDataset and WriteSequence.
void RunImport(const ImportOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
