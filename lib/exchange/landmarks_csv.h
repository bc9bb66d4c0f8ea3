// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// A table of all objects, a row each below a header, fields quoted as RFC 4180 says. Metres, and
// degrees where a column says so; centre and quaternion are world_from_object. `yaw_deg` is about
// the support normal. Standard deviations (`sigma_`) are empty where there is no covariance, all
// that is of a landmark where there is none, and what an evaluation says (`fate` and on) without
// it.
std::string LandmarksCsvText(const std::vector<World>& worlds);

}  // namespace soslam
