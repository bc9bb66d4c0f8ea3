// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "inspection/projection.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// The lines of a grid on each of Sequence::planes, in the world; none on planes without anything.
using PlaneGrids = std::vector<std::vector<LineSegment3>>;

// On the sequence's planes, around true centres where they are known, else around what its cameras
// see there.
PlaneGrids GridsOfSequence(const Sequence& sequence);
// On the map's planes, around its landmarks.
PlaneGrids GridsOfMap(const MapEstimate& map, const Sequence& sequence);

// By plane: lines [x, y, z, x, y, z] in the world.
nlohmann::json PageGrids(const PlaneGrids& grids);

// What a frame's camera sees of the planes of its detections: lines as pixels [x, y, x, y]. Where
// the camera is may depend on the detection.
nlohmann::json PageGridInFrame(
    const Sequence& sequence, int frame_index, const PlaneGrids& grids,
    const std::function<Rigid3d(const Detection&)>& camera_from_world_for);

// Where the camera of a detection is to see the sequence's own planes: given ones from the true
// pose where it is known, estimated ones where the detection's plane_in_camera is, which odometry
// need not agree with.
Rigid3d CameraAbovePlane(const Sequence& sequence, const Detection& detection);

// The direction in a segment's world that is up: the normal of that plane of its detections which
// is closest to upright in its images; without such planes, upright in its images.
Eigen::Vector3d UpOfSegment(const Sequence& sequence, int segment);

}  // namespace soslam
