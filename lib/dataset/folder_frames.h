// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/dataset_files.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "dataset/tum_list.h"

namespace soslam {

// The images of a folder: those of the list, or else those that `boxes` name by their timestamps.
// Absolute paths into the folder become relative, ICL-NUIM's frame numbers seconds. Throws
// InputError naming line or box.
std::vector<ListedImage> ListImages(const std::filesystem::path& folder, const DatasetFiles& files,
                                    const ImportOptions& options,
                                    const std::vector<LabelledBox>& boxes);

// A frame for each image, with the poses that are nearest in time or of its name, and says on
// stdout how many of them have one. EuRoC's poses are of a body, to which the camera is fixed as
// said, or else of the camera. Only in format soslam the listed image files have to be there.
// What time stamps look wrong is added to `findings`. Throws InputError.
std::vector<ListedFrame> ReadFolderFrames(const std::filesystem::path& folder,
                                          const DatasetFiles& files, const ImportOptions& options,
                                          const std::vector<ListedImage>& images,
                                          const std::optional<Rigid3d>& body_from_camera,
                                          std::vector<Finding>* findings);

}  // namespace soslam
