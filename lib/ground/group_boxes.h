// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/ground_points.h"
#include "ground/horizontal_planes.h"
#include "model/sequence.h"

namespace soslam {

// Detections (indices in Sequence::detections) in groups, ascending, each of one object: their
// boxes are at the same place and of the same size, whatever their labels. The place of a box is at
// the depth of the points in it, those of the nearest surface, or, where there are none, at the
// depth of the plane under its lower edge. Boxes whose depth is unknown are in no group.
std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes);

}  // namespace soslam
