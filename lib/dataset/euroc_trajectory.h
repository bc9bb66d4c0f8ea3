// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/tum_list.h"

namespace soslam {

// A trajectory as EuRoC has it (state_groundtruth_estimate0/data.csv): lines "timestamp,x,y,z,
// qw,qx,qy,qz" with commas, timestamps in nanoseconds, which become seconds; further columns
// (velocity, biases) are not read. The pose is world_from_body ("RS": the sensor's in the reference
// frame): of the camera only where the body is the camera, see Calibration::body_from_camera. By
// ascending time, as ReadTrajectory. Throws InputError naming the line.
std::vector<TimedPose> ReadEurocTrajectory(const std::filesystem::path& path);

}  // namespace soslam
