// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// A frame's detections, in the order of objects.
std::span<const Detection> DetectionsIn(const Sequence& sequence, int frame_index);

// Where the thing in a box stands, seen from the camera: where the ray through the middle of the
// box's lower edge meets its support plane. None when it does not in front of the camera: the box
// then ends at or above the plane's horizon.
std::optional<Eigen::Vector3d> FootInCamera(const Camera& camera, const Box& box,
                                            const Plane& plane_in_camera);

// The boxes of the frame's other objects that may hide a detection's: those whose foot is nearer to
// the camera.
std::vector<Box> NearerBoxes(const Sequence& sequence, const Detection& detection);

// Decides NearerBoxes for all detections of a sequence, among those of `in_view`: of the same
// frames, objects and planes, with one detection for each object in a frame. Takes a sort for each
// frame, and a box for each detection.
void ListBoxesInView(const Sequence& in_view, Sequence* sequence);

// The boxes that may hide a detection of the sequence, as was decided at import.
std::vector<Box> BoxesInFront(const Sequence& sequence, const Detection& detection);

}  // namespace soslam
