// SPDX-License-Identifier: BSD-3-Clause
#include "model/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soslam {
namespace {

// How far in front of the camera (m, along its axis) a detection's foot is; infinite without one.
// Without planes a value in the same order for things on one plane: what ends lower in the image is
// nearer.
double FootDepth(const Sequence& sequence, const Detection& detection) {
  if (sequence.planes.empty()) return -detection.box.y_max;
  const auto foot =
      FootInCamera(sequence.CameraOf(detection), detection.box, detection.plane_in_camera);
  return foot ? foot->z() : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<Eigen::Vector3d> FootInCamera(const Camera& camera, const Box& box,
                                            const Plane& plane_in_camera) {
  const Eigen::Vector3d ray = camera.Ray({box.Centre().x(), box.y_max});
  const double depth = -plane_in_camera.offset / plane_in_camera.normal.dot(ray);
  if (!(depth > 0.0) || !std::isfinite(depth)) return std::nullopt;
  return depth * ray;
}

std::span<const Detection> DetectionsIn(const Sequence& sequence, int frame_index) {
  const auto& all = sequence.detections;
  return {std::ranges::lower_bound(all, frame_index, {}, &Detection::frame_index),
          std::ranges::upper_bound(all, frame_index, {}, &Detection::frame_index)};
}

std::vector<Box> NearerBoxes(const Sequence& sequence, const Detection& detection) {
  const double own_depth = FootDepth(sequence, detection);
  std::vector<Box> nearer;
  for (const Detection& other : DetectionsIn(sequence, detection.frame_index)) {
    if (other.object_index != detection.object_index && FootDepth(sequence, other) < own_depth) {
      nearer.push_back(other.box);
    }
  }
  return nearer;
}

}  // namespace soslam
