// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/dataset_files.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "dataset/trajectories.h"

namespace soslam {

// The images of a folder: those of the list, otherwise those that `boxes` name by their timestamps.
// Absolute paths into the folder become relative, ICL-NUIM's frame numbers become seconds. Throws
// InputError naming line or box.
std::vector<ListedImage> ListImages(const std::filesystem::path& folder, const DatasetFiles& files,
                                    const ImportOptions& options,
                                    const std::vector<LabelledBox>& boxes);

// Creates a frame per image with the pose nearest in time or with the same image name, and prints
// to stdout how many have one. EuRoC's poses are those of a body; `body_from_camera` is the
// camera's pose in it, or none if the body is the camera. Only in format soslam the listed image
// files must exist. Suspicious time stamps are added to `findings`. Throws InputError.
std::vector<ListedFrame> ReadFolderFrames(const std::filesystem::path& folder,
                                          const DatasetFiles& files, const ImportOptions& options,
                                          const std::vector<ListedImage>& images,
                                          const std::optional<Rigid3d>& body_from_camera,
                                          std::vector<Finding>* findings);

}  // namespace soslam
