// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "geometry/box.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"

namespace soslam {

// DetectionRow::object_id of a row that is not used, as it is of no object; nobody's id.
inline constexpr int kNoObject = std::numeric_limits<int>::min();

// A 2D box of one object in one frame, as a dataset has it.
struct DetectionRow {
  std::string place;  // "<file>:<line>", for error messages
  int frame_id;
  int object_id;
  std::string label;
  double score;
  Box box;
  // Where the lens put it, in a dataset whose images are distorted.
  std::optional<Box> box_in_image_file = std::nullopt;
  // Where the dataset's labels say more about this object in this frame; frames are the camera's.
  double truncation = 0.0;  // how much of it is outside the image, in the dataset's own measure
  int occlusion = 0;        // how much of it is hidden, in the dataset's own measure
  std::optional<Plane> plane_in_camera = std::nullopt;  // what it stands on
  std::optional<Landmark> true_landmark_in_camera = std::nullopt;
};

}  // namespace soslam
