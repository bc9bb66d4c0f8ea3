// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/detection_row.h"

namespace soslam {

// The rows of detections.csv: a table whose first line names the columns, in any order: frame,
// object_id, label, score, x1, y1, x2, y2; others are ignored. A frame is a 0-based row of rgb.txt.
// No quoting: a label cannot hold a comma. Throws InputError naming the line, and for a file
// without header.
std::vector<DetectionRow> ReadDetections(const std::filesystem::path& path);

}  // namespace soslam
