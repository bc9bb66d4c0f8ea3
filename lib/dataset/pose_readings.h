// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "geometry/rigid3.h"

namespace soslam {

// What a file may mean by a pose that is read as world_from_camera with quaternion qx qy qz qw.
struct PoseReading {
  const char* name;  // "the inverse, camera_from_world"
  const char* cause;
  const char* remedy;
  Rigid3d (*Apply)(const Rigid3d& as_read);  // world_from_camera as it is meant
};

// The readings that people's files have been seen to mean, but for the right one.
std::span<const PoseReading> PoseReadings();

}  // namespace soslam
