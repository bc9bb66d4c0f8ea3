// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "initialisation/options.h"
#include "orientation/options.h"

namespace soslam {

// soslam-initialise: sequence.json and the semantic table, for CubeSLAM's cuboids also edges.h5, to
// initial.json: files "sequence", "table", "edges" (optional), "output". Throws SettingsError when
// a method that needs edges has none, NothingUsableError when no observation gave a landmark.
void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads);

// soslam-refine: initial.json and edges.h5 to refined.json and symmetry.h5: files "sequence",
// "table", "initial", "edges", "output", "curves". Throws SettingsError for a descriptor without
// derivative where one is needed, NothingUsableError when initial.json has no single-frame
// landmarks.
void RunRefine(const OrientationOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
