// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "dataset/reconstruct_options.h"

namespace soslam {

// soslam-reconstruct: poses, calibration and sparse points by structure from motion. Files:
// "dataset", a folder with rgb.txt, the images and what is given; "model" (optional), a finished
// model of COLMAP, which does not run then; "output", the folder for camera.json, odometry.txt,
// points.h5 and reconstruction.json, usually the same as "dataset", where COLMAP's own files are in
// colmap/. What is given is not changed. Prints a one-line summary. Throws SettingsError when
// COLMAP is missing, and when poses of another source would be replaced; InputError for bad files,
// fewer than two images, and images of several sizes; NothingUsableError when no image has
// features, or nothing was triangulated; NumericalError when no two images make a model.
void RunReconstruct(const ReconstructOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
