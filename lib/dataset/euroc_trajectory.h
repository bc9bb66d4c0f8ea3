// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/tum_list.h"

namespace soslam {

// Reads a trajectory in EuRoC's format (state_groundtruth_estimate0/data.csv): lines
// "timestamp,x,y,z,qw,qx,qy,qz", timestamps in nanoseconds, converted to seconds; further columns
// (velocity, biases) are ignored. The pose is world_from_body ("RS": sensor in the reference
// frame); it is that of the camera only if the body is the camera, see
// Calibration::body_from_camera. Sorted by time, see ReadTrajectory. Throws InputError naming the
// line.
std::vector<TimedPose> ReadEurocTrajectory(const std::filesystem::path& path);

}  // namespace soslam
