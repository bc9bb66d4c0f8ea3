// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Detections in COCO's results format: [{"image_id", "category_id", "bbox": [x, y, w, h],
// "score"}], pixels from the image's outer corner; or a data set of COCO's with such boxes as its
// "annotations", those of crowds left out. Without "score" it is 1. A "track_id" of an entry, or of
// its "attributes", says which object it is of.
//
// `dataset`, when given, is the JSON file that the results belong to: its "images" ({"id",
// "file_name"}) and "categories" ({"id", "name"}) say what the ids mean; those of a data set that
// holds the boxes itself are in it. Without either an integral image_id is a 0-based row of the
// image list, and category_id is COCO's own (1 to 90). A text as image_id is the name of an image.
// In file order. Throws InputError with file and JSON pointer.
std::vector<LabelledBox> ReadCocoResults(
    const std::filesystem::path& results,
    const std::optional<std::filesystem::path>& dataset = std::nullopt);

}  // namespace soslam
