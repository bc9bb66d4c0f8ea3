// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "geometry/box.h"

namespace soslam {

// Which image a box is in, as its file says it: the 0-based row of the list of images, or a file
// name of the image, with or without its folder and extension. FrameLookup finds the image.
using FrameKey = std::variant<int, std::string>;

// A detection: a row of somebody's file.
struct LabelledBox {
  std::string place;  // "<file>:<line>" or "<file>#<JSON pointer>", for error messages
  FrameKey frame;
  std::string label;
  double score;  // 1 where the file has none
  Box box;
  std::optional<int> object_id = std::nullopt;  // which object it is of, where the file says so
};

// Detectors and annotation tools measure from the outer corner of the top-left pixel; this project
// from that pixel's centre, half a pixel further in.
inline Box FromCornerOrigin(const Box& box) {
  return {box.x_min - 0.5, box.y_min - 0.5, box.x_max - 0.5, box.y_max - 0.5};
}
inline Box ToCornerOrigin(const Box& box) {
  return {box.x_min + 0.5, box.y_min + 0.5, box.x_max + 0.5, box.y_max + 0.5};
}

}  // namespace soslam
