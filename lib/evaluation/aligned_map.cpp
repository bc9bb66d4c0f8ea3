// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/aligned_map.h"

#include <algorithm>

namespace soslam {

AlignedMap ApplyAlignments(const Sequence& sequence, const std::vector<ObjectEstimate>& estimates,
                           const std::vector<Rigid3d>& world_from_camera,
                           const std::vector<Plane>& planes_in_world,
                           const Alignments& alignments) {
  AlignedMap map;
  const auto detections = DetectionsByObject(sequence);
  std::vector<const ObjectEstimate*> by_object;
  for (const ObjectEstimate& estimate : estimates) {
    const bool is_seen = !detections[static_cast<size_t>(estimate.object_index)].empty();
    if (estimate.landmark_in_world && is_seen) by_object.push_back(&estimate);
  }
  std::ranges::stable_sort(by_object, {}, &ObjectEstimate::object_index);
  for (const ObjectEstimate* estimate : by_object) {
    const auto index = static_cast<size_t>(estimate->object_index);
    const auto first = static_cast<size_t>(detections[index].front());
    const int segment = sequence.FrameOf(sequence.detections[first]).segment;
    const Alignment& alignment = alignments.of_segment.at(segment);
    map.landmarks.push_back(
        {estimate->object_index, segment, alignment.Apply(*estimate->landmark_in_world)});
    const int plane = sequence.objects[index].plane_index;
    map.plane_of_landmark.emplace_back();
    if (plane >= 0 && static_cast<size_t>(plane) < planes_in_world.size()) {
      map.plane_of_landmark.back() = alignment.Apply(planes_in_world[static_cast<size_t>(plane)]);
    }
  }
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    map.world_from_camera.push_back(
        alignments.of_segment.at(sequence.frames[i].segment).Apply(world_from_camera[i]));
  }
  return map;
}

}  // namespace soslam
