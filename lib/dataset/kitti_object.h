// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads the object benchmark of KITTI: label_2/NNNNNN.txt, calib/NNNNNN.txt (P2) and, as far as
// there are any, image_2/NNNNNN.png. Frames are single views, so each is a segment of its own with
// the camera's frame as its world. A frame's id is its number; an object's 1000 times that plus the
// position of its label, counted from 0. Each object stands on a plane of its own with the object's
// id: the bottom face of its labelled box. Throws InputError, SettingsError.
DatasetContent ReadKittiObject(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam
