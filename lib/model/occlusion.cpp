// SPDX-License-Identifier: BSD-3-Clause
#include "model/occlusion.h"

#include <algorithm>
#include <limits>

namespace soslam {
namespace {

// How far in front of the camera (m, along its axis) a detection's foot is. Infinite when the ray
// does not meet the plane in front of the camera: the box then ends at or above the plane's
// horizon. Without planes a value in the same order for things on one plane: what ends lower in the
// image is nearer.
double FootDepth(const Sequence& sequence, const Detection& detection) {
  const Box& box = detection.box;
  if (sequence.planes.empty()) return -box.y_max;
  const Camera& camera = sequence.CameraOf(detection);
  const Plane& plane = detection.plane_in_camera;
  const double depth = -plane.offset / plane.normal.dot(camera.Ray({box.Centre().x(), box.y_max}));
  return depth > 0.0 ? depth : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<Box> NearerBoxes(const Sequence& sequence, const Detection& detection) {
  const double own_depth = FootDepth(sequence, detection);
  std::vector<Box> nearer;
  for (const Detection& other : std::ranges::equal_range(sequence.detections, detection.frame_index,
                                                         {}, &Detection::frame_index)) {
    if (other.object_index != detection.object_index && FootDepth(sequence, other) < own_depth) {
      nearer.push_back(other.box);
    }
  }
  return nearer;
}

}  // namespace soslam
