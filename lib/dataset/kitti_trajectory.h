// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// Reads a trajectory in the format of KITTI's odometry benchmark: one line per frame, the upper 3 x
// 4 of world_from_camera row by row, metres. The k-th pose is that of frame k, from 0. Files round
// matrices, so each is replaced by the nearest rotation. Throws InputError naming the line when a
// matrix is no rotation within rounding; also when there is no pose.
std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path);

}  // namespace soslam
