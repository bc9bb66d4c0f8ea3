// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// First category id of labels that are not COCO's; they are numbered in alphabetical order.
inline constexpr int kFirstOtherCategory = 1001;

// Expected boxes of the landmarks, in COCO's results format: for each frame and each landmark that
// is wholly in front of its camera and in the image, whether occluded or not,
//   {"image_id": the frame's id, "category_id", "bbox": [x, y, w, h] from the image's outer corner,
//    cut at its border, "score": of the object, "category_name": its label, "object_id"}.
// category_id is COCO's own if the label is one of COCO's, ignoring case and blanks.
std::string CocoResultsText(const std::vector<World>& worlds);

// The meaning of the ids in these results, in COCO's dataset format: "info", "licenses", "images",
// "categories", and as "annotations" either the same boxes (if they are ground truth for a
// comparison) or none.
enum class CocoAnnotations { kNone, kVisibleBoxes };
std::string CocoDatasetText(const std::vector<World>& worlds, CocoAnnotations annotations);

}  // namespace soslam
