// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads a folder of images: the project's own format, TUM RGB-D or ICL-NUIM. All three have a list
// of images, trajectories (pose estimates and true poses; at least one of the two), a camera and
// detections, in files and formats given by the options, and optionally planes.json and
// objects.json. Differences:
//
//   soslam    the listed images must exist when a stage reads them
//   tum_rgbd  images may be absent; lists may be pairs, colour images first
//   icl_nuim  like tum_rgbd, but depth images first; times are frame numbers; camera and world
//             have y up, and are mirrored (see FromIclNuim)
//
// Without planes.json no plane is known. Each detection without object id is a separate object.
// Ground truth, if present, is stored in the sequence for evaluation. Throws InputError,
// SettingsError.
DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
