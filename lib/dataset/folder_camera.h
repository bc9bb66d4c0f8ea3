// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "dataset/calibration_file.h"
#include "dataset/import_options.h"

namespace soslam {

// The camera of a folder of images, as the options say, or else the camera file. That of ICL-NUIM
// is the one with y down that gives the same images. Throws SettingsError for options that cannot
// be; InputError naming the field.
Calibration ReadFolderCamera(const std::optional<std::filesystem::path>& camera_file,
                             const ImportOptions& options);

}  // namespace soslam
