// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/estimate_ground.h"
#include "model/finding.h"

namespace soslam {

// A scale that cannot be told or is uncertain, and what contradicts it; a camera height that says
// nothing; an up direction that is uncertain; no support plane.
std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options);

}  // namespace soslam
