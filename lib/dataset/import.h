// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Reads a dataset folder in the format that the options name, checks everything in it and drops
// the detections that the options leave out, each with a counted reason. By default these are those
// that the protocol of the paper's experiments does not use. Frames without a pose estimate are
// left out.
//
// Formats: soslam, tum_rgbd, icl_nuim (ReadSoslamFolder), kitti_tracking (ReadKittiTracking),
// kitti_object (ReadKittiObject), slam_synthetic (ReadSlamSynthetic).
//
// `files_read`, when not null, becomes the list of the files that were read. Throws InputError,
// naming file and line or field, for whatever is missing, malformed, contradictory or cannot be
// right (see CheckDataset); SettingsError for options that cannot be; NothingUsableError when no
// detection is left.
Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options,
                       std::vector<std::filesystem::path>* files_read = nullptr);

}  // namespace soslam
