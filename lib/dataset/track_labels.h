// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/dataset_json.h"
#include "dataset/detection_row.h"

namespace soslam {

// Gives all rows of an object one label, as detectors use several labels for one object: the most
// frequent one (ties: larger sum of scores, then alphabetical), or that of objects.json unless more
// than half of the rows have another. Returns the number of rows whose label changed. Throws
// InputError, naming a row, for an object whose label in objects.json differs from that of most
// rows.
int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows);

}  // namespace soslam
