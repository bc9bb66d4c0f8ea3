// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/box.h"

namespace soslam {

// A row of detections.csv, as it stands there.
struct DetectionRow {
  std::string place;  // "<file>:<line>", for error messages
  int frame_id;       // 0-based row of rgb.txt
  int object_id;
  std::string label;
  double score;
  Box box;
};

// The rows of a table whose first line names the columns, in any order: frame, object_id, label,
// score, x1, y1, x2, y2; others are ignored. No quoting: a label cannot hold a comma. Throws
// InputError naming the line, and for a file without header.
std::vector<DetectionRow> ReadDetections(const std::filesystem::path& path);

}  // namespace soslam
