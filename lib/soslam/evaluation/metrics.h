// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Single-frame estimates are compared in the frame of their camera, with the truth of that frame if
// there is one, so that trajectory errors have no effect; estimates over several frames in the
// world, without objects that move. Objects without ground truth or detections are left out. The
// trajectory error is computed for sequences of one segment only. `alignment` is that of
// map_quality.
Metrics EvaluateLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                          AlignmentKind alignment = AlignmentKind::kAuto);
Metrics EvaluateMap(const Sequence& sequence, const MapEstimate& map,
                    AlignmentKind alignment = AlignmentKind::kAuto);

// The comparison with the boxes of held-out frames. `world_from_camera`: one per
// Sequence::held_out, in the landmarks' world. None without held-out frames, or if no landmarks of
// objects were estimated.
std::optional<HeldOutMetrics> EvaluateHeldOut(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const std::vector<Rigid3d>& world_from_camera);
// The poses of held-out frames in the world of a map: odometry, continued from the map's pose of
// the previous frame in the same segment (of the next one if there is none). `world_from_camera`
// has one pose per Sequence::frames.
std::vector<Rigid3d> HeldOutPoses(const Sequence& sequence,
                                  const std::vector<Rigid3d>& world_from_camera);

// The comparison of a map with all true objects, independent of the ids of detections. None without
// true objects that the map should contain. A map without landmarks misses them all.
// `world_from_camera` and `planes_in_world` as in MapEstimate.
std::optional<MapQuality> EvaluateMapQuality(const Sequence& sequence,
                                             const std::vector<ObjectEstimate>& estimates,
                                             const std::vector<Rigid3d>& world_from_camera,
                                             const std::vector<Plane>& planes_in_world,
                                             AlignmentKind alignment);

}  // namespace soslam
