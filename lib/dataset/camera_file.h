// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/calibration_file.h"

namespace soslam {

// The camera of a file, whatever its format, which is told by its name: .yaml, .yml, .xml
// (ReadCalibration), .txt (ReadColmapCamera; .bin, its binary files, is refused), or else JSON:
// nerfstudio's, as it has "frames" or "fl_x", or a camera.json (ReadCamera). Throws InputError.
Calibration ReadCameraFile(const std::filesystem::path& path);

}  // namespace soslam
