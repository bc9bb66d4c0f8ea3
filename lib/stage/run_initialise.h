// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "initialisation/options.h"

namespace soslam {

// soslam-initialise: sequence.json and the semantic table to initial.json: files "sequence",
// "table", "output". Throws NothingUsableError when no observation gave a landmark.
void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
