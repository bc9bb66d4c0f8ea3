// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/geometry/landmark.h"

namespace soslam {

// The volume (m^3) of the intersection of the oriented boxes that circumscribe two landmarks, exact
// for any rotations: one box is clipped by the six faces of the other.
double IntersectionVolume(const Landmark& one, const Landmark& other);

// Intersection over union of the two circumscribed boxes, in [0, 1]; 0 where a volume is beyond any
// number.
double BoxIou(const Landmark& one, const Landmark& other);

}  // namespace soslam
