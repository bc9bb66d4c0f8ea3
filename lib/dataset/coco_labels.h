// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace soslam {

// The names of COCO's 80 object classes, in the order that detectors trained on COCO number them,
// from 0 (T.-Y. Lin et al., "Microsoft COCO: Common Objects in Context", ECCV 2014).
const std::vector<std::string>& CocoLabels();

// The position in CocoLabels of a category id of COCO's annotation files. Those ids run from 1 to
// 90 and leave out eleven numbers, whose categories were dropped; none for these and beyond.
std::optional<int> CocoClassIndex(int category_id);

// The category id of a position in CocoLabels.
int CocoCategoryId(int class_index);

}  // namespace soslam
