// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/calibration_file.h"

namespace soslam {

// Reads a camera file; the format follows from its name: .yaml, .yml, .xml (ReadCalibration), .txt
// (ReadColmapCamera; its binary .bin is refused), otherwise JSON: nerfstudio's if it has "frames"
// or "fl_x", or a camera.json (ReadCamera). Throws InputError.
Calibration ReadCameraFile(const std::filesystem::path& path);

}  // namespace soslam
