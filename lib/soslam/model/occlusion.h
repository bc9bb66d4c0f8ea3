// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// Detections of a frame, ordered by object.
std::span<const Detection> DetectionsIn(const Sequence& sequence, int frame_index);

// Ground contact point of the object in a box, in the camera frame: the intersection of the ray
// through the middle of the box's lower edge with its support plane. None when it is not in front
// of the camera, that is when the box ends at or above the plane's horizon.
std::optional<Eigen::Vector3d> GroundContactInCamera(const Camera& camera, const Box& box,
                                                     const Plane& plane_in_camera);

// Boxes of the frame's other objects that may occlude this detection: those whose contact point is
// nearer to the camera.
std::vector<Box> NearerBoxes(const Sequence& sequence, const Detection& detection);

// Computes NearerBoxes for all detections of a sequence, from the detections of `in_view`, which
// has the same frames, objects and planes and one detection per object and frame. Needs one sort
// per frame and one box per detection.
void ListBoxesInView(const Sequence& in_view, Sequence* sequence);

// Boxes that may occlude a detection of the sequence, as computed at import.
std::vector<Box> BoxesInFront(const Sequence& sequence, const Detection& detection);

}  // namespace soslam
