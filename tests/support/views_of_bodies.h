// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "support/upright_bodies.h"

namespace soslam {

// Adds an object with ground truth and views of it somewhere on the ground, whose boxes follow from
// its outlines. Each frame has its own world, whose origin is the body.
inline void AddViewsOfBody(const std::string& label, const Eigen::Vector3d& half_axes,
                           const ShapeExponents& shape_exponents, int views,
                           const std::function<Box(const Box& outline)>& box_of,
                           Sequence* sequence) {
  GroundTruth truth;
  truth.landmark_in_world.half_axes = half_axes;
  const int object = static_cast<int>(sequence->objects.size());
  sequence->objects.push_back({object, label, 0, truth});
  sequence->camera = TestCamera();
  for (int view = 0; view < views;) {
    Landmark in_camera = RandomUprightBody(RandomFloor(), shape_exponents);
    in_camera.half_axes = half_axes;
    const auto outline = OutlineBox(TestCamera(), in_camera);
    if (!outline) continue;
    Frame frame;
    frame.true_world_from_camera = in_camera.frame_from_object.Inverse();
    Detection detection;
    detection.frame_index = static_cast<int>(sequence->frames.size());
    detection.object_index = object;
    detection.box = box_of(*outline);
    sequence->frames.push_back(frame);
    sequence->detections.push_back(detection);
    ++view;
  }
}

}  // namespace soslam
