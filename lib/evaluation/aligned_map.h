// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "evaluation/alignment.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// A landmark of a map, aligned with the true world.
struct AlignedLandmark {
  int object_index = 0;  // into Sequence::objects
  int segment = 0;
  Landmark landmark_in_world;
};

// A map, aligned with the true world.
struct AlignedMap {
  std::vector<AlignedLandmark> landmarks;               // by object
  std::vector<Rigid3d> world_from_camera;               // one per Sequence::frames
  std::vector<std::optional<Plane>> plane_of_landmark;  // support plane of each landmark
};

// `world_from_camera` and `planes_in_world` as in MapEstimate.
AlignedMap ApplyAlignments(const Sequence& sequence, const std::vector<ObjectEstimate>& estimates,
                           const std::vector<Rigid3d>& world_from_camera,
                           const std::vector<Plane>& planes_in_world, const Alignments& alignments);

}  // namespace soslam
