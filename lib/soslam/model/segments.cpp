// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/segments.h"

#include <cmath>

namespace soslam {

std::vector<int> ListSegments(const Sequence& sequence) {
  std::vector<int> segments;
  for (const Frame& frame : sequence.frames) {
    if (segments.empty() || segments.back() != frame.segment) segments.push_back(frame.segment);
  }
  return segments;
}

std::vector<std::optional<int>> SegmentsOfObjects(const Sequence& sequence) {
  std::vector<std::optional<int>> segments(sequence.objects.size());
  if (sequence.frames.empty()) return segments;
  const int first = sequence.frames.front().segment;
  if (sequence.frames.back().segment == first) segments.assign(segments.size(), first);
  for (const Detection& detection : sequence.detections) {
    auto& segment = segments[detection.object_index];
    if (!segment) segment = sequence.FrameOf(detection).segment;
  }
  return segments;
}

Eigen::Vector3d UpOfSegment(const Sequence& sequence, int segment) {
  // Least cosine of the angle between up and the upright direction of the segment's images.
  constexpr double kMinUprightCosine = 0.2;
  // Least length of the sum of n upright directions, in units of sqrt(n), which is that of random
  // directions.
  constexpr double kMinUprightSum = 0.5;
  Eigen::Vector3d upright = Eigen::Vector3d::Zero();
  double frames = 0.0;
  for (const Frame& frame : sequence.frames) {
    if (frame.segment != segment) continue;
    upright -= frame.world_from_camera.rotation * Eigen::Vector3d::UnitY();
    ++frames;
  }
  if (!(upright.norm() > kMinUprightSum * std::sqrt(frames)))
    upright = Eigen::Vector3d::UnitZ();  // the camera looks in all directions
  upright.normalize();
  Eigen::Vector3d up = upright;
  double best = kMinUprightCosine;
  if (sequence.planes.empty()) return up;
  for (const Detection& detection : sequence.detections) {
    if (sequence.FrameOf(detection).segment != segment) continue;
    const int plane = sequence.ObjectOf(detection).plane_index;
    if (plane == kNoPlane) continue;
    const Eigen::Vector3d& normal = sequence.planes[plane].plane_in_world.normal;
    if (normal.dot(upright) <= best) continue;
    best = normal.dot(upright);
    up = normal;
  }
  return up;
}

}  // namespace soslam
