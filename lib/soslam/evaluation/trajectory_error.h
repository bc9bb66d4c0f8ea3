// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "soslam/geometry/rigid3.h"
#include "soslam/model/sequence.h"

namespace soslam {

// An estimated and a true pose of one frame, world_from_camera.
struct PosePair {
  Rigid3d estimated;
  Rigid3d truth;
};

// The poses of the frames that have a true one, by segment. `world_from_camera`: the estimates, one
// per Sequence::frames.
std::map<int, std::vector<PosePair>> PosePairs(const Sequence& sequence,
                                               const std::vector<Rigid3d>& world_from_camera);

// Difference of two trajectories, medians over frames.
struct TrajectoryGap {
  double rotation_deg = 0.0;
  double translation_m = 0.0;
};
// `pairs` must not be empty.
TrajectoryGap ComputeGap(const std::vector<PosePair>& pairs);

// Extent of a camera's path (m): the diagonal of the box around it.
double ComputeExtent(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose);

// True if the median distances of both cameras from the middles of their paths are about equal.
bool HaveSameScale(const std::vector<PosePair>& pairs);

// True if the gap is no more than the usual drift of odometry over this extent.
bool IsDrift(const TrajectoryGap& gap, double extent_m);

// True if both trajectories are in the same world and unit, apart from drift.
bool AreInOneWorld(const std::vector<PosePair>& pairs);

// Camera centres, in columns.
Eigen::Matrix3Xd CollectCentres(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose);

// The root mean square distance of the truth from the estimate, moved and perhaps scaled so that it
// is smallest (Umeyama).
double ResidualOfFit(const Eigen::Matrix3Xd& estimated, const Eigen::Matrix3Xd& truth,
                     bool with_scale);

// Absolute trajectory error, m: ResidualOfFit of camera centres, without scale. None with fewer
// than three poses.
std::optional<double> AbsoluteTrajectoryError(const std::vector<PosePair>& pairs);

}  // namespace soslam
