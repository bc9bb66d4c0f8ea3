// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/estimate_ground.h"
#include "model/finding.h"

namespace soslam {

// Checks whose findings contradict a scale: the heights of objects contradict what it is known by,
// or one another.
inline constexpr const char* kKnownScaleCheck = "scale_of_objects_differs";
inline constexpr const char* kObjectsCheck = "scale_contradicted";

// A scale that cannot be told, is uncertain or that objects contradict; a camera height that says
// nothing; an up direction that is uncertain; no support plane.
std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options);

}  // namespace soslam
