// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/dataset_files.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "dataset/tum_list.h"

namespace soslam {

// The images of a folder: those of the list, or else those that `boxes` name by their timestamps.
// ICL-NUIM's frame numbers become seconds. Throws InputError naming line or box.
std::vector<ListedImage> ListImages(const DatasetFiles& files, const ImportOptions& options,
                                    const std::vector<LabelledBox>& boxes);

// A frame for each image, with the poses that are nearest in time, and says on stdout how many of
// them have one. Only in format soslam the listed image files have to be there. What time stamps
// look wrong is added to `findings`. Throws InputError.
std::vector<ListedFrame> ReadFolderFrames(const std::filesystem::path& folder,
                                          const DatasetFiles& files, const ImportOptions& options,
                                          const std::vector<ListedImage>& images,
                                          std::vector<Finding>* findings);

}  // namespace soslam
