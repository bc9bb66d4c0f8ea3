// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads a folder of images: the project's own format, TUM RGB-D or ICL-NUIM. All three have a list
// of images, trajectories (pose estimates and true poses; at least one of the two), a camera and
// detections, in files and formats that the options name, and optionally planes.json and
// objects.json. What differs:
//
//   soslam    the listed images have to be there when a stage wants them
//   tum_rgbd  images may be absent; lists may be pairs, colour images first
//   icl_nuim  the same, depth images first; time is the number of a frame; camera and world have
//             y up, and are mirrored (see icl_nuim.h)
//
// Without planes.json no plane is known. Detections without object ids are of an object each.
// Ground truth, when present, fills what the sequence has for evaluation. Throws InputError,
// SettingsError.
DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
