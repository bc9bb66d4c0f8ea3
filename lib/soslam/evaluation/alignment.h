// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/evaluation/trajectory_error.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/estimates.h"
#include "soslam/model/finding.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// The paper's protocol has no settings: numbers from different runs stay comparable.
struct EvaluateOptions {
  AlignmentKind alignment = AlignmentKind::kAuto;

  void Describe(OptionVisitor& visit) {
    visit.Group("Comparison of maps");
    visit.Choice("alignment", &alignment, kAlignmentKindNames,
                 "how a map is moved, for map_quality only, so that its camera centres fit the "
                 "true ones best: as a whole (rigid), also scaled (similarity), not at all (none); "
                 "auto: none where odometry and truth are in one world, rigid where the odometry "
                 "has a world of its own, similarity where it has a scale of its own");
  }
};

// The alignment with the smallest root mean square distance of camera centres (Umeyama). If these
// do not determine the rotation, it is the mean over the cameras' relative rotations. A similarity
// whose scale they do not determine is refused: it becomes rigid. `kind` is not kAuto.
Alignment Align(const std::vector<PosePair>& pairs, AlignmentKind kind);

// One for each segment, as each has a world of its own. `world_from_camera`: the estimates, one per
// Sequence::frames. Findings say where an alignment is not as asked for, and where the estimate has
// another scale than the truth and is not scaled.
Alignments AlignSegments(const Sequence& sequence, const std::vector<Rigid3d>& world_from_camera,
                         AlignmentKind choice);

// A landmark of a map, aligned with the true world.
struct AlignedLandmark {
  int object_index = 0;  // into Sequence::objects
  int segment = 0;
  Landmark landmark_in_world;
  std::optional<Plane> plane_in_world = std::nullopt;  // its support plane
};

// A map, aligned with the true world.
struct AlignedMap {
  std::vector<AlignedLandmark> landmarks;  // by object
  std::vector<Rigid3d> world_from_camera;  // one per Sequence::frames
};

// `world_from_camera` and `planes_in_world` as in MapEstimate. Landmarks of objects that no
// detection shows are left out.
AlignedMap ApplyAlignments(const Sequence& sequence, const std::vector<ObjectEstimate>& estimates,
                           const std::vector<Rigid3d>& world_from_camera,
                           const std::vector<Plane>& planes_in_world, const Alignments& alignments);

}  // namespace soslam
