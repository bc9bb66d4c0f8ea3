// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Reads detections in OA-SLAM's format (M. Zins, G. Simon, M.-O. Berger, "OA-SLAM", ISMAR 2022):
// [{"file_name", "detections": [{"category_id", "detection_score", "bbox": [x1, y1, x2, y2]}]}],
// pixels from the image's outer corner. `labels` are the names of the categories, from 0; OA-SLAM's
// own files use COCO's 80. In file order. Throws InputError with file and JSON pointer.
std::vector<LabelledBox> ReadOaSlamBoxes(const std::filesystem::path& path,
                                         const std::vector<std::string>& labels);

}  // namespace soslam
