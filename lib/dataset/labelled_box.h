// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "geometry/box.h"

namespace soslam {

// Reference of a box to its image, as in the file: the 0-based row of the image list, or a file
// name with or without its folder and extension. FrameLookup finds the image.
using FrameKey = std::variant<int, std::string>;

// A detection in an external file.
struct LabelledBox {
  std::string place;  // "<file>:<line>" or "<file>#<JSON pointer>", for error messages
  FrameKey frame;
  std::string label;
  double score;  // 1 where the file has none
  Box box;
  // Object id, where the file has one.
  std::optional<int> object_id = std::nullopt;
};

// Conversion of the pixel origin: detectors and annotation tools measure from the outer corner of
// the top-left pixel, this project from that pixel's centre, half a pixel further in.
inline Box FromCornerOrigin(const Box& box) {
  return {box.x_min - 0.5, box.y_min - 0.5, box.x_max - 0.5, box.y_max - 0.5};
}
inline Box ToCornerOrigin(const Box& box) {
  return {box.x_min + 0.5, box.y_min + 0.5, box.x_max + 0.5, box.y_max + 0.5};
}

}  // namespace soslam
