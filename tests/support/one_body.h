// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "soslam/geometry/landmark.h"
#include "soslam/model/sequence.h"
#include "support/looking_at.h"
#include "support/random.h"

namespace soslam {

// Cameras around the z axis that look at a point of it.
inline std::vector<Rigid3d> CamerasOnArc(int cameras, double arc_rad, double radius_m = 4.0,
                                         double height_m = 1.6, double target_height_m = 0.4) {
  std::vector<Rigid3d> world_from_camera;
  for (int i = 0; i < cameras; ++i) {
    const double angle = arc_rad * i / (cameras - 1);
    world_from_camera.push_back(
        LookingAt({radius_m * std::cos(angle), radius_m * std::sin(angle), height_m},
                  {0.0, 0.0, target_height_m}));
  }
  return world_from_camera;
}

// The only object, on the floor z = 0, as these cameras see it: with exact boxes.
inline Sequence ViewsOfBody(const Landmark& body, const std::vector<Rigid3d>& world_from_camera) {
  Sequence sequence;
  sequence.camera = TestCamera();
  sequence.planes = {{0, Plane()}};
  sequence.objects = {{0, "", 0, GroundTruth{body}}};
  for (size_t i = 0; i < world_from_camera.size(); ++i) {
    const Rigid3d camera_from_world = world_from_camera[i].Inverse();
    Frame frame;
    frame.id = static_cast<int>(i);
    frame.world_from_camera = world_from_camera[i];
    sequence.frames.push_back(frame);
    sequence.detections.push_back({frame.id, 0, 1.0,
                                   *OutlineBox(sequence.camera, Transform(camera_from_world, body)),
                                   Transform(camera_from_world, Plane())});
  }
  return sequence;
}

}  // namespace soslam
