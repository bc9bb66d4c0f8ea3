// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// `world_from_camera`: one per Sequence::held_out, in the landmarks' world. None without held-out
// frames, or if no landmarks of objects were estimated.
std::optional<HeldOutMetrics> EvaluateHeldOut(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const std::vector<Rigid3d>& world_from_camera);

// The poses of held-out frames in the world of a map: odometry, continued from the map's pose of
// the previous frame in the same segment (of the next one if there is none). `world_from_camera`
// has one pose per Sequence::frames.
std::vector<Rigid3d> HeldOutPoses(const Sequence& sequence,
                                  const std::vector<Rigid3d>& world_from_camera);

}  // namespace soslam
