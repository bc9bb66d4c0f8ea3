// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "geometry/rigid3.h"

namespace soslam {

// What a file may mean by a pose that is read as world_from_camera with quaternion qx qy qz qw.
struct PoseReading {
  const char* name;  // "the poses are the inverse, camera_from_world"
  const char* cause;
  const char* remedy;
  Rigid3d (*Apply)(const Rigid3d& as_read);  // world_from_camera as it is meant
  bool are_boxes_mirrored = false;           // left to right, in the camera as it is meant
  bool is_turned_in_body = false;            // as a camera may be in any body
};

// The readings that people's files have been seen to mean, but for the right one.
std::span<const PoseReading> PoseReadings();

}  // namespace soslam
