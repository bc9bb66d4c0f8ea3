// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "ground/options.h"

namespace soslam {

// soslam-ground: files "sequence", "points" (points.h5), "table" and, with verticals, the images of
// folder "dataset" to "output", the sequence with z up, in metres, with support planes, and
// "world", world.json. Throws InputError for several segments, NothingUsableError without frames,
// SettingsError for verticals without a dataset.
void RunGround(const GroundOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
