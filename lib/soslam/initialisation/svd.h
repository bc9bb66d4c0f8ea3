// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"

namespace soslam {

// Dual quadric tangent to the given planes in the least squares sense (Nicholson et al. 2019, the
// paper's baseline SVD): the ten coefficients of Q* solve one homogeneous linear equation per
// plane. Needs boxes from three views with parallax; without parallax the result is meaningless.
// Empty for fewer than 9 planes or if the solution is not finite.
std::optional<DualQuadricLandmark> LandmarkFromTangentPlanes(
    const std::vector<Plane>& planes_in_world);

}  // namespace soslam
