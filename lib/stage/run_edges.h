// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "image/edge_maps.h"

namespace soslam {

// soslam-edges: computes the edge maps of the undistorted image of every frame. Files: "dataset",
// the folder of the frames' images; "sequence", sequence.json; "output", edges.h5. Throws
// InputError for an image that is missing, damaged, outside the dataset folder or not of the
// camera's size; NothingUsableError when no frame has an image; SettingsError.
void RunEdges(const EdgesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
