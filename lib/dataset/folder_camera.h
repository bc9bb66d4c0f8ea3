// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "dataset/import_options.h"
#include "geometry/camera.h"
#include "geometry/distortion.h"

namespace soslam {

// The camera of a folder of images, y down, and what its lens does to images and boxes.
struct FolderCamera {
  Camera camera;
  std::optional<Distortion> distortion;
};

// As the options say, or else camera.json. The camera of ICL-NUIM is the one with y down that gives
// the same images. Throws SettingsError for options that cannot be; InputError naming the field.
FolderCamera ReadFolderCamera(const std::optional<std::filesystem::path>& camera_json,
                              const ImportOptions& options);

}  // namespace soslam
