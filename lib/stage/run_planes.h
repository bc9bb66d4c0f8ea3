// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planes/options.h"
#include "stage/stage_files.h"

namespace soslam {

// soslam-planes: files "sequence" and "table" to "output", the sequence with estimated planes, and
// "report", planes.json. Throws SettingsError for planes = given, NothingUsableError as
// EstimatePlanes.
void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
