// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "soslam/dataset/calibration_file.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// Work for COLMAP: images of one camera.
struct ColmapJob {
  std::filesystem::path dataset;                    // folder that the names are relative to
  std::vector<std::string> images;                  // names
  std::optional<LensCamera> camera = std::nullopt;  // none: estimated from nothing or EXIF
  bool camera_is_fixed = false;
  // world_from_camera of each image, which needs a fixed camera; empty: they are estimated.
  std::vector<std::optional<Rigid3d>> poses = {};
  // Boxes of each image in which no features are sought, pixels of the image file; empty: none.
  std::vector<std::vector<Box>> masked = {};
  bool exhaustive = true;  // match each image with each other; otherwise with its successors
  int threads = 1;
};

// Runs COLMAP's programs (3.8 to 3.13) on the processor: features, matches and mapper, or
// triangulation with given poses, in the folder `workspace`, with progress on stderr. Returns the
// folders of the models and COLMAP's version. A workspace of the same job is continued, or used if
// it is finished; another is replaced. What COLMAP prints is in log.txt there. Throws SettingsError
// if there is no program "colmap" on PATH, NothingUsableError when no image has features or a
// program fails, NumericalError when there is no model.
std::vector<std::filesystem::path> RunColmap(const ColmapJob& job,
                                             const std::filesystem::path& workspace,
                                             std::string* version);

// The models in a folder: itself, or its subfolders, sorted by number.
std::vector<std::filesystem::path> ColmapModelsIn(const std::filesystem::path& folder);

}  // namespace soslam
