// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// A trajectory in the format of KITTI's odometry benchmark: 12 numbers a line, the upper 3 x 4 of
// world_from_camera by rows, metres; line i is frame i. Throws InputError naming the line; also
// when there is none.
std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path);

}  // namespace soslam
