// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "initialisation/cuboid_score.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// CubeSLAM's cuboids of all detections: the best one at each yaw, lowest cost first. `edges_of`
// gives the edge maps of a frame, and is called from several threads. Failures:
// frame_without_image, no_edges, no_solution.
LandmarkEstimates InitialiseCuboids(const Sequence& sequence,
                                    const std::function<EdgeMaps(const Frame&)>& edges_of,
                                    const CuboidOptions& options, int threads);

}  // namespace soslam
