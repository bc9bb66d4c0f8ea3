// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// A table of all objects, one row each below a header, fields quoted as in RFC 4180. Metres, and
// degrees if a column's name contains it; centre and quaternion are world_from_object. `yaw_deg` is
// about the support normal. Empty are: standard deviations (`sigma_`) without a covariance, all
// values of a missing landmark, and the verdict (`fate` and following) without an evaluation.
std::string LandmarksCsvText(const std::vector<World>& worlds);

// The poses in the text format of the TUM RGB-D benchmark: a line "timestamp tx ty tz qx qy qz qw"
// per frame, world_from_camera, below a comment that states this. Numbers round-trip exactly.
std::string TumTrajectoryText(const World& world);

}  // namespace soslam
