// SPDX-License-Identifier: BSD-3-Clause
#include "model/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

// Detections in view of a frame, nearest first.
class FrameByDepth {
 public:
  FrameByDepth(const Sequence& in_view, int frame_index) {
    for (const Detection& detection : DetectionsIn(in_view, frame_index)) {
      entries_.push_back({GroundContactDepth(in_view, detection), &detection});
    }
    std::ranges::stable_sort(entries_, {}, &Entry::depth);
    for (size_t i = 0; i < entries_.size(); ++i) {
      rank_of_object_[entries_[i].detection->object_index] = static_cast<int>(i);
    }
  }

  std::vector<Box> Boxes() const {
    std::vector<Box> boxes;
    for (const Entry& entry : entries_) boxes.push_back(entry.detection->box);
    return boxes;
  }

  void Decide(const Sequence& sequence, Detection* detection) const {
    const double depth = GroundContactDepth(sequence, *detection);
    const auto end = std::ranges::lower_bound(entries_, depth, {}, &Entry::depth);
    detection->nearer_in_view = static_cast<int>(end - entries_.begin());
    const auto own = rank_of_object_.find(detection->object_index);
    if (own != rank_of_object_.end() && own->second < detection->nearer_in_view) {
      detection->own_in_view = own->second;
    }
  }

 private:
  struct Entry {
    double depth;
    const Detection* detection;
  };
  std::vector<Entry> entries_;
  std::map<int, int> rank_of_object_;
};

}  // namespace

void ListBoxesInView(const Sequence& in_view, Sequence* sequence) {
  auto detection = sequence->detections.begin();
  for (size_t i = 0; i < sequence->frames.size(); ++i) {
    const auto frame_index = static_cast<int>(i);
    const FrameByDepth by_depth(in_view, frame_index);
    sequence->frames[i].boxes_in_view = by_depth.Boxes();
    for (; detection != sequence->detections.end() && detection->frame_index == frame_index;
         ++detection) {
      by_depth.Decide(*sequence, &*detection);
    }
  }
}

std::vector<Box> BoxesInFront(const Sequence& sequence, const Detection& detection) {
  const std::vector<Box>& in_view = sequence.FrameOf(detection).boxes_in_view;
  std::vector<Box> boxes = detection.nearer_boxes;
  boxes.reserve(boxes.size() + static_cast<size_t>(detection.nearer_in_view));
  for (int i = 0; i < detection.nearer_in_view; ++i) {
    if (i != detection.own_in_view) boxes.push_back(in_view[i]);
  }
  return boxes;
}

}  // namespace soslam
