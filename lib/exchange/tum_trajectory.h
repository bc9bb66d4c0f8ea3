// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/world.h"

namespace soslam {

// The poses in the text format of the TUM RGB-D benchmark: a line "timestamp tx ty tz qx qy qz qw"
// per frame, world_from_camera, below a comment that states this. Numbers round-trip exactly.
std::string TumTrajectoryText(const World& world);

}  // namespace soslam
