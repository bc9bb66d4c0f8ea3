// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "image/track_options.h"

namespace soslam {

// soslam-track: sparse points from features that are followed through the images, triangulated from
// the frames' poses, which stay as they are. Files: "dataset", the folder of the frames' images;
// "sequence", sequence.json; "output", points.h5, whose world is that of the sequence's poses.
// Prints a one-line summary. Where no track gives a point, the file is empty, with a warning.
// Throws InputError for a bad image, NothingUsableError when no frame has an image.
void RunTrack(const TrackOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
