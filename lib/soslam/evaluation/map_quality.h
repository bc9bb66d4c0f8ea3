// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "soslam/evaluation/alignment.h"
#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/map_reasons.h"
#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

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
