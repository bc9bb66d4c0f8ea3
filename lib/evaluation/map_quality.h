// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "evaluation/alignment.h"
#include "evaluation/landmark_errors.h"
#include "evaluation/map_reasons.h"
#include "model/estimates.h"
#include "model/metrics.h"
#include "model/sequence.h"

namespace soslam {

// Comparison of a map with all true objects, independent of the ids of detections.

// None without true objects that the map should contain. A map without landmarks misses them all.
// `world_from_camera` and `planes_in_world` as in MapEstimate.
std::optional<MapQuality> EvaluateMapQuality(const Sequence& sequence,
                                             const std::vector<ObjectEstimate>& estimates,
                                             const std::vector<Rigid3d>& world_from_camera,
                                             const std::vector<Plane>& planes_in_world,
                                             AlignmentKind alignment);

}  // namespace soslam
