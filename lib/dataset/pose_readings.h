// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "geometry/rigid3.h"

namespace soslam {

// An alternative convention of a pose that was read as world_from_camera with quaternion qx qy qz
// qw.
struct PoseReading {
  const char* name;  // "the poses are the inverse, camera_from_world"
  const char* cause;
  const char* remedy;
  Rigid3d (*Apply)(const Rigid3d& as_read);  // converts to the true world_from_camera
  bool are_boxes_mirrored = false;           // boxes are also mirrored left to right
  bool is_turned_in_body = false;            // a rotation that a camera may also have in a body
};

// The wrong conventions that occur in practice.
std::span<const PoseReading> PoseReadings();

}  // namespace soslam
