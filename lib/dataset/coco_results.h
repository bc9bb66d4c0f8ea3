// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Reads detections in COCO's results format: [{"image_id", "category_id", "bbox": [x, y, w, h],
// "score"}], pixels from the image's outer corner; or a COCO data set with such boxes as
// "annotations", without those of crowds. A missing "score" is 1. A "track_id" of an entry, or of
// its "attributes", is the object id.
//
// `dataset`, when given, is the JSON file that the results belong to: its "images" ({"id",
// "file_name"}) and "categories" ({"id", "name"}) define the ids; a data set with boxes contains
// them itself. Without either, an integer image_id is a 0-based row of the image list, and
// category_id is COCO's own (1 to 90). A text as image_id is the name of an image. In file order.
// Throws InputError with file and JSON pointer.
std::vector<LabelledBox> ReadCocoResults(
    const std::filesystem::path& results,
    const std::optional<std::filesystem::path>& dataset = std::nullopt);

}  // namespace soslam
