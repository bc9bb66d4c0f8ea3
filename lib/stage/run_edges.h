// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "image/edge_maps.h"
#include "stage/stage_files.h"

namespace soslam {

// Computes the edge maps of every frame that has an image, whose lens distortion is undone first.
// Files: "dataset", the folder that the
// frames' images are in; "sequence", sequence.json; "output", edges.h5. Throws InputError for an
// image that is missing, damaged, outside the dataset folder or not of the camera's size;
// NothingUsableError when no frame has an image; SettingsError.
void RunEdges(const EdgesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
