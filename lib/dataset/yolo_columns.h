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
  std::vector<double> extras;  // what follows: none, one or two numbers
  double score = 1.0;
  std::optional<int> track = std::nullopt;
};

// Finds out, of all rows together, which of the extras are confidences and which tracks, as tools
// write both, in either order, and fills `score` and `track`. Confidences are in [0, 1]; tracks are
// integers from -1 (none) on.
//
//   one extra   confidences if all can be (also if all are 1), or else tracks, of which no image
//   may
//               have one twice; beside rows with two extras confidences only
//   two extras  confidence and track, as Ultralytics writes them, if all can be, or else track and
//               confidence
//
// Throws InputError, naming a row, when it is none of these.
void ReadYoloExtras(std::vector<YoloRow>* rows);

}  // namespace soslam
