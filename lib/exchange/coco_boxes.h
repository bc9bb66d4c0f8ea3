// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// Categories of labels that are none of COCO's have ids from here on, in alphabetical order.
inline constexpr int kFirstOtherCategory = 1001;

// Where the landmarks should be seen, in COCO's results format: for each frame and each landmark
// that is wholly in front of its camera and in the image, hidden by others or not,
//   {"image_id": the frame's id, "category_id", "bbox": [x, y, w, h] from the image's outer corner,
//    cut at its border, "score": of the object, "category_name": its label, "object_id"}.
// category_id is COCO's own where the label is one of COCO's, whatever case and blanks.
std::string CocoResultsText(const std::vector<World>& worlds);

// What the ids in these results mean, in COCO's dataset format: "info", "licenses", "images",
// "categories", and as "annotations" the same boxes (of ground truth, to compare results with), or
// none.
enum class CocoAnnotations { kNone, kVisibleBoxes };
std::string CocoDatasetText(const std::vector<World>& worlds, CocoAnnotations annotations);

}  // namespace soslam
