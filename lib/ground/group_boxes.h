// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/horizontal_planes.h"
#include "model/sequence.h"

namespace soslam {

// Detections (indices in Sequence::detections) in groups, ascending, each of one object. The
// upright rectangle that a box shows, at the depth of the points in it or of a plane under its
// lower edge, predicts the boxes of its object in all other frames. Rectangles are chosen in the
// order of how many boxes agree with them. Boxes whose depth is unknown and that agree with none
// are in no group.
std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes, int threads);

}  // namespace soslam
