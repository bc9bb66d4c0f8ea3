// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/dataset_json.h"
#include "dataset/detection_row.h"

namespace soslam {

// Gives all rows of an object one label, as detectors call one thing by several names: that which
// most of them have (of as many that with the larger sum of scores, then the first by name), or
// that of objects.json unless more than half have another. Returns how many rows had another label.
// Throws InputError, naming a row, for an object that objects.json calls otherwise than most rows.
int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows);

}  // namespace soslam
