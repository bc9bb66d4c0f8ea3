// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/colmap_model.h"

namespace soslam {

// Readers of COLMAP's binary model files, for colmap_model.cpp. Throw InputError, naming the entry,
// for a file that ends too early or too late, a number that is not finite, and counts beyond what
// the file can hold. Read in whole: at most 1 GiB.
std::vector<LensCamera> ReadColmapCamerasBinary(const std::filesystem::path& path);
std::vector<ColmapImage> ReadColmapImagesBinary(const std::filesystem::path& path);
std::vector<ColmapPoint> ReadColmapPointsBinary(const std::filesystem::path& path);

}  // namespace soslam
