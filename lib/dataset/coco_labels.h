// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace soslam {

// Names of COCO's 80 object classes, in the order of detectors trained on COCO, from 0 (T.-Y. Lin
// et al., "Microsoft COCO: Common Objects in Context", ECCV 2014).
const std::vector<std::string>& CocoLabels();

// Index in CocoLabels of a category id of COCO's annotation files. These ids run from 1 to 90
// without ten numbers of dropped categories; none for these and others.
std::optional<int> CocoClassIndex(int category_id);

// Category id of an index in CocoLabels.
int CocoCategoryId(int class_index);

}  // namespace soslam
