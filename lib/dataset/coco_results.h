// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Detections in COCO's results format: [{"image_id", "category_id", "bbox": [x, y, w, h],
// "score"}], pixels from the image's outer corner.
//
// `dataset`, when given, is the JSON file that the results belong to: its "images" ({"id",
// "file_name"}) and "categories" ({"id", "name"}) say what the ids mean. Without it an integral
// image_id is a 0-based row of the image list, a text the name of an image, and category_id is
// COCO's own (1 to 90). In file order. Throws InputError with file and JSON pointer.
std::vector<LabelledBox> ReadCocoResults(
    const std::filesystem::path& results,
    const std::optional<std::filesystem::path>& dataset = std::nullopt);

}  // namespace soslam
