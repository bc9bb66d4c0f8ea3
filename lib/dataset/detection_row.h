// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "geometry/box.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"

namespace soslam {

// DetectionRow::object_id of an unused row that belongs to no object; never a real id.
inline constexpr int kNoObject = std::numeric_limits<int>::min();

// A 2D box of one object in one frame, as in the dataset.
struct DetectionRow {
  std::string place;  // "<file>:<line>", for error messages
  int frame_id;
  int object_id;
  std::string label;
  double score;
  Box box;
  // Distorted box in the image file, in a dataset with distorted images.
  std::optional<Box> box_in_image_file = std::nullopt;
  // Further values from the dataset's labels, if any; geometry is in the camera frame.
  double truncation = 0.0;  // amount outside the image, in the dataset's own measure
  int occlusion = 0;        // occlusion level, in the dataset's own measure
  std::optional<Plane> plane_in_camera = std::nullopt;  // its support plane
  std::optional<Landmark> true_landmark_in_camera = std::nullopt;
};

}  // namespace soslam
