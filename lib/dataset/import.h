// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Reads a dataset folder in the format given by the options, checks it completely and drops the
// detections that the options exclude, each with a counted reason. The defaults follow the protocol
// of the paper's experiments. Frames without a pose estimate are left out.
//
// Formats: soslam, tum_rgbd, icl_nuim (ReadSoslamFolder), kitti_tracking (ReadKittiTracking),
// kitti_object (ReadKittiObject), slam_synthetic (ReadSlamSynthetic).
//
// `files_read`, if not null, becomes the list of the files that were read. Throws InputError,
// naming file and line or field, for data that are missing, malformed, contradictory or certainly
// wrong (see CheckDataset); SettingsError for invalid options; NothingUsableError when no detection
// is left.
Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options,
                       std::vector<std::filesystem::path>* files_read = nullptr);

}  // namespace soslam
