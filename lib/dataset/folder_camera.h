// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "dataset/calibration_file.h"
#include "dataset/import_options.h"

namespace soslam {

// The camera of a folder of images, from the options, otherwise from the camera file. ICL-NUIM's
// camera is converted to the one with y down that gives the same images. Throws SettingsError for
// invalid options; InputError naming the field.
Calibration ReadFolderCamera(const std::optional<std::filesystem::path>& camera_file,
                             const ImportOptions& options);

}  // namespace soslam
