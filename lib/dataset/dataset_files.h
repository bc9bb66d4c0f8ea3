// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/import_options.h"

namespace soslam {

// The text files of a folder of images that an import with certain options reads.
struct DatasetFiles {
  std::optional<std::filesystem::path> images;  // the list; none: detections name their images
  std::optional<std::filesystem::path> camera;  // none: the options say it
  std::optional<std::filesystem::path> planes;  // planes.json
  std::filesystem::path detections;             // a file or a folder
  std::optional<std::filesystem::path> class_names;
  std::filesystem::path trajectory;     // the pose estimates: the odometry or the true poses
  bool trajectory_is_fallback = false;  // the file that the options ask for is absent
  std::optional<std::filesystem::path> groundtruth;
  std::optional<std::filesystem::path> objects;  // objects.json

  // Each of them once, those in the folder of detections one by one.
  std::vector<std::filesystem::path> All() const;
};

// Throws InputError naming all required files that are missing. Odometry and true poses with the
// usual names may be absent; files that the options name have to be there.
DatasetFiles FindDatasetFiles(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
