// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/estimates.h"
#include "model/map_points.h"
#include "model/sequence.h"
#include "report/page_parts.h"

namespace soslam {

// Image points of the points that may be of the objects of a map, in the frames that see them: by
// selected detection [x, y, responsibility in %, ...], or null where there are none. `points` are
// those that the map was made from. Throws InputError where the map refers to a point that is not
// among them.
nlohmann::json PagePoints(const MapEstimate& map, const std::vector<MapPoint>& points,
                          const Sequence& sequence, const PageSelection& selection);

// Numbers of an object's points: {"count", "of_object": the sum of their responsibilities}, or null
// without any.
nlohmann::json PagePointCounts(const ObjectEstimate& estimate);

}  // namespace soslam
