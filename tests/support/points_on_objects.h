// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"
#include "support/random.h"

namespace soslam {

// The point as all frames see it that have it in their image.
inline MapPoint Seen(const Sequence& sequence, const Eigen::Vector3d& point_in_world) {
  MapPoint point{Eigen::Vector3d::Zero(), 0.1, {}};  // positions are not used
  for (const Frame& frame : sequence.frames) {
    const auto pixel = sequence.camera.Project(frame.world_from_camera.Inverse() * point_in_world);
    if (pixel && sequence.camera.IsInside(*pixel)) point.observations.push_back({frame.id, *pixel});
  }
  return point;
}

inline const Landmark& TrueBody(const Sequence& sequence, size_t object_index) {
  return sequence.objects[object_index].ground_truth->landmark_in_world;
}

// Points on the faces of all objects that can be seen, without occlusion.
inline std::vector<MapPoint> PointsOnObjects(const Sequence& sequence, int count) {
  std::vector<MapPoint> points;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const Landmark& body = TrueBody(sequence, i);
    for (int k = 0; k < count; ++k) {
      Eigen::Vector3d in_object = body.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
      in_object[k % 3] = std::copysign(body.half_axes[k % 3], in_object[k % 3]);
      if (k % 3 == 2) in_object.z() = body.half_axes.z();  // the top, not the foot
      points.push_back(Seen(sequence, body.frame_from_object * in_object));
    }
  }
  return points;
}

}  // namespace soslam
