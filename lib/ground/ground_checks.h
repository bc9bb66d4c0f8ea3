// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/estimate_ground.h"
#include "model/finding.h"

namespace soslam {

// Checks whose findings mean that up may be quite wrong: few objects stand on planes; planes say
// another way to hold the cameras than boxes; only planes tell up.
inline constexpr const char* kFewObjectsOnPlanesCheck = "few_objects_on_planes";
inline constexpr const char* kHoldingOfPlanesCheck = "camera_holding_of_planes";
inline constexpr const char* kCamerasTurnedCheck = "cameras_turned";

// A scale that cannot be told or is uncertain, and what contradicts it; a camera height that says
// nothing; an up direction that is uncertain; no support plane.
std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options);

}  // namespace soslam
