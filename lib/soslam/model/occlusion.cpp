// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soslam {
namespace {

// Depth (m, along the optical axis) of a detection's ground contact point; infinite without one.
// Where support planes are unknown, a value with the same order for objects on one plane: a box
// that ends lower in the image is nearer.
double GroundContactDepth(const Sequence& sequence, const Detection& detection) {
  if (!sequence.HasSupports()) return -detection.box.y_max;
  const auto foot =
      GroundContactInCamera(sequence.CameraOf(detection), detection.box, detection.plane_in_camera);
  return foot ? foot->z() : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<Eigen::Vector3d> GroundContactInCamera(const Camera& camera, const Box& box,
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
  const double own_depth = GroundContactDepth(sequence, detection);
  std::vector<Box> nearer;
  for (const Detection& other : DetectionsIn(sequence, detection.frame_index)) {
    if (other.object_index != detection.object_index &&
        GroundContactDepth(sequence, other) < own_depth) {
      nearer.push_back(other.box);
    }
  }
  return nearer;
}

namespace {

struct BoxAtDepth {
  double depth;  // see GroundContactDepth
  int object_index;
  Box box;
};

// The boxes of a frame, nearest first.
std::vector<BoxAtDepth> BoxesByDepth(const Sequence& sequence, int frame_index) {
  std::vector<BoxAtDepth> boxes;
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    boxes.push_back(
        {GroundContactDepth(sequence, detection), detection.object_index, detection.box});
  }
  std::ranges::stable_sort(boxes, {}, &BoxAtDepth::depth);
  return boxes;
}

}  // namespace

void ListBoxesInView(const Sequence& in_view, Sequence* sequence) {
  std::vector<std::vector<BoxAtDepth>> boxes_of_frames;
  for (size_t i = 0; i < sequence->frames.size(); ++i) {
    boxes_of_frames.push_back(BoxesByDepth(in_view, static_cast<int>(i)));
    std::vector<Box>& boxes_in_view = sequence->frames[i].boxes_in_view;
    boxes_in_view.clear();
    for (const BoxAtDepth& box : boxes_of_frames.back()) boxes_in_view.push_back(box.box);
  }
  for (Detection& detection : sequence->detections) {
    const std::vector<BoxAtDepth>& boxes = boxes_of_frames[detection.frame_index];
    const double depth = GroundContactDepth(*sequence, detection);
    const auto end = std::ranges::lower_bound(boxes, depth, {}, &BoxAtDepth::depth);
    const auto own =
        std::ranges::find(boxes.begin(), end, detection.object_index, &BoxAtDepth::object_index);
    detection.nearer_in_view = static_cast<int>(end - boxes.begin());
    if (own != end) detection.own_in_view = static_cast<int>(own - boxes.begin());
  }
}

std::vector<Box> BoxesInFront(const Sequence& sequence, const Detection& detection) {
  const std::vector<Box>& in_view = sequence.FrameOf(detection).boxes_in_view;
  std::vector<Box> boxes;
  for (int i = 0; i < detection.nearer_in_view; ++i) {
    if (i != detection.own_in_view) boxes.push_back(in_view[i]);
  }
  return boxes;
}

}  // namespace soslam
