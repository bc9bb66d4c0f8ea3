// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "planes/options.h"

namespace soslam {

// soslam-planes: files "sequence", "table" and, with verticals, the images of folder "dataset" to
// "output", the sequence with estimated planes, and "report", planes.json. Throws SettingsError for
// planes = given and for verticals without a dataset, InputError for estimated planes of several
// segments, NothingUsableError as EstimatePlanes, and when no object is on a plane.
void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
