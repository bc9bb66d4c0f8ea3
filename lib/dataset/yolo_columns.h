// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// A line of YOLO's labels, in numbers.
struct YoloRow {
  std::string place;  // "<file>:<line>"
  std::string image;
  int class_index;
  std::array<double, 4> box;
  std::vector<double> extras;  // further values: none, one or two
  double score = 1.0;
  std::optional<int> track = std::nullopt;
};

// Determines from all rows together which of the extras are confidences and which tracks, as tools
// write both in either order, and fills `score` and `track`. Confidences are in [0, 1]; tracks are
// integers from -1 (none).
//
//   one extra   confidences if all values allow it (also if all are 1), otherwise tracks, each
//               at most once per image; only confidences if other rows have two extras
//   two extras  confidence and track, as written by Ultralytics, if all values allow it,
//               otherwise track and confidence
//
// Throws InputError, naming a row, in all other cases.
void ReadYoloExtras(std::vector<YoloRow>* rows);

}  // namespace soslam
