// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "geometry/rigid3.h"

namespace soslam {

// Pose of an image identified by name instead of time, as in structure from motion.
struct NamedPose {
  std::string place;          // "<file>:<line>" or "<file>#<JSON pointer>", for error messages
  std::string image;          // path, as the file has it
  Rigid3d world_from_camera;  // camera x right, y down, z forward
};

}  // namespace soslam
