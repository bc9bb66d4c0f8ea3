// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "model/sequence.h"
#include "report/page_selection.h"

namespace soslam {

// The data of a sequence on a page, whatever the method. Frames and detections are the selected
// ones, and indices refer to these lists:
//   counts: frames, objects, detections of the whole sequence
//   frames: id, timestamp, segment, width, height, pose (odometry) and true_pose or null, shown;
//     of those shown grid: see PageGridInFrame
//   objects: id, label, segment (null if unknown), plane (index or null), truth (landmark or null)
//   detections: frame and object (indices), box, truth (outline or null); the truth is the cuboid
//     around the object, with which estimates are compared
//   planes: see PageGrids
//   segments: up, a direction of the world
//   rejected: reason -> detections that were not used
nlohmann::json PageSequence(const Sequence& sequence, const PageSelection& selection);

}  // namespace soslam
