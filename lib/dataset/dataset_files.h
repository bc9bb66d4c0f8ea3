// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/import_options.h"

namespace soslam {

// The text files of a dataset folder that an import with certain options reads.
struct DatasetFiles {
  std::filesystem::path images;         // rgb.txt
  std::filesystem::path camera;         // camera.json
  std::filesystem::path planes;         // planes.json
  std::filesystem::path detections;     // detections.csv
  std::filesystem::path trajectory;     // odometry.txt or groundtruth.txt: the pose estimates
  bool trajectory_is_fallback = false;  // the file that the options ask for is absent
  std::optional<std::filesystem::path> groundtruth;  // groundtruth.txt
  std::optional<std::filesystem::path> objects;      // objects.json

  // Each of them once.
  std::vector<std::filesystem::path> All() const;
};

// Throws InputError naming a required file that is missing.
DatasetFiles FindDatasetFiles(const std::filesystem::path& folder, TrajectorySource trajectory);

}  // namespace soslam
