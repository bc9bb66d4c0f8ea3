// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "soslam/dataset/import_options.h"

namespace soslam {

// Text files of a folder of images that an import with given options reads.
struct DatasetFiles {
  std::optional<std::filesystem::path>
      images;  // the image list; none: detections name their images
  std::optional<std::filesystem::path> camera;  // none: the options have the camera
  std::optional<std::filesystem::path> planes;  // planes.json
  std::filesystem::path detections;             // a file or a folder
  std::optional<std::filesystem::path> class_names;
  std::filesystem::path trajectory;     // the pose estimates: odometry or true poses
  bool trajectory_is_fallback = false;  // the file requested by the options is absent
  std::optional<std::filesystem::path> groundtruth;
  std::optional<std::filesystem::path> objects;  // objects.json

  // Each file once, including every file in the folder of detections.
  std::vector<std::filesystem::path> All() const;
};

// Finds the files of a dataset. Throws InputError naming all missing required files. Odometry and
// true poses may be absent under their default names; files that the options name must exist.
DatasetFiles FindDatasetFiles(const std::filesystem::path& folder, const ImportOptions& options);

// Entries of a folder, sorted by name. Throws InputError when it cannot be listed.
std::vector<std::filesystem::path> FolderEntries(const std::filesystem::path& folder);

// A file in an archive.
struct ArchivedText {
  std::string name;  // its path in the archive
  std::string text;
};

// Reads the files of an archive (tar, also compressed; zip) whose names (ArchivedText::name) are
// `wanted`, sorted by name. Throws InputError for a file that is no archive, is truncated, or
// unpacks to more than text files would.
std::vector<ArchivedText> ReadTextArchive(
    const std::filesystem::path& path,
    const std::function<bool(const std::filesystem::path&)>& wanted);

}  // namespace soslam
