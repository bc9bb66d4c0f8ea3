// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// An estimated and a true pose of one frame, world_from_camera.
struct PosePair {
  Rigid3d estimated;
  Rigid3d truth;
};

// Difference of two trajectories, medians over frames.
struct TrajectoryGap {
  double rotation_deg = 0.0;
  double translation_m = 0.0;
};
// `pairs` must not be empty.
TrajectoryGap GapOf(const std::vector<PosePair>& pairs);

// Extent of a camera's path (m): the diagonal of the box around it.
double ExtentOf(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose);

// True if the median distances of both cameras from the middles of their paths are about equal.
bool HaveSameScale(const std::vector<PosePair>& pairs);

// True if the gap is no more than the usual drift of odometry over this extent.
bool IsDrift(const TrajectoryGap& gap, double extent_m);

// True if both trajectories are in the same world and unit, apart from drift.
bool AreInOneWorld(const std::vector<PosePair>& pairs);

// Absolute trajectory error, m: the root mean square distance between estimated and true camera
// centres after the rigid alignment that makes it smallest (Umeyama, no scale). Frames without
// truth are left out. None with fewer than three true poses.
std::optional<double> AbsoluteTrajectoryError(
    const std::vector<Rigid3d>& world_from_camera,
    const std::vector<std::optional<Rigid3d>>& true_world_from_camera);

}  // namespace soslam
