// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// What pages show of a sequence whatever the method; of frames that are not among `shown` (indices,
// ascending) no pixels:
//   frames: id, timestamp, segment, width, height, pose (odometry) and true_pose or null, grid: the
//     planes of what was detected there, lines as pixels [x, y, x, y]
//   objects: id, label, segment (null without detections), plane (id), truth (landmark or null),
//     rotationally_symmetric
//   detections: frame and object (indices), score, box, truth (outline or null); the truth is the
//     cuboid around the object, with which estimates are compared
//   planes: id, normal, offset, grid: lines in the world [x, y, z, x, y, z]
//   rejected: reason -> detections that were not used
nlohmann::json PageSequence(const Sequence& sequence, const std::vector<int>& shown);

}  // namespace soslam
