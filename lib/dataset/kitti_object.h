// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads the object benchmark of KITTI: label_2/NNNNNN.txt, calib/NNNNNN.txt (P2) and, if present,
// image_2/NNNNNN.png. Frames are independent views, so each is its own segment with the camera's
// frame as its world. A frame's id is its number; an object's id is 1000 times that plus the index
// of its label. Each object has its own support plane with the object's id: the bottom face of its
// labelled box. Throws InputError, SettingsError.
DatasetContent ReadKittiObject(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
