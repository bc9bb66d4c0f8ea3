// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "constraints/tangency.h"
#include "geometry/landmark.h"

namespace soslam {

// The edges of a box as they are to be compared with a landmark near this one. Where a bound cuts
// off the point at which the landmark is tangent to another edge, that edge is one of the visible
// part: the whole object may reach beyond it, so that it is a bound as well.
std::array<BoxEdge, 4> VisibleEdges(const std::array<BoxEdge, 4>& edges,
                                    const Landmark& landmark_in_camera);

}  // namespace soslam
