// SPDX-License-Identifier: BSD-3-Clause
#include "ground/similarity.h"

namespace soslam {

Sequence Transformed(const Similarity& target_from_source, Sequence sequence) {
  for (Frame& frame : sequence.frames) {
    Rigid3d& pose = frame.world_from_camera;
    pose = {(target_from_source.rigid.rotation * pose.rotation).normalized(),
            target_from_source * pose.translation};
  }
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  for (Detection& detection : sequence.detections) detection.plane_in_camera = Plane();
  return sequence;
}

std::vector<MapPoint> Transformed(const Similarity& target_from_source,
                                  std::vector<MapPoint> points) {
  for (MapPoint& point : points) {
    point.position_in_world = target_from_source * point.position_in_world;
  }
  return points;
}

}  // namespace soslam
