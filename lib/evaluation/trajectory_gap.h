// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// An estimated and a true pose of one frame, world_from_camera.
struct PosePair {
  Rigid3d estimated;
  Rigid3d truth;
};

// How far apart two trajectories are, medians over frames.
struct TrajectoryGap {
  double rotation_deg = 0.0;
  double translation_m = 0.0;
};
// There has to be one pair at least.
TrajectoryGap GapOf(const std::vector<PosePair>& pairs);

// How far a camera moves (m): the diagonal of the box around its path.
double ExtentOf(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose);

// Whether both cameras move about as far, by the medians of their distances from where they are
// mostly.
bool HaveSameScale(const std::vector<PosePair>& pairs);

// Whether the gap is what odometry drifts, of a camera that moves so far.
bool IsDrift(const TrajectoryGap& gap, double extent_m);

// Whether both trajectories are of one world and one unit, apart by no more than drift.
bool AreInOneWorld(const std::vector<PosePair>& pairs);

}  // namespace soslam
