// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// A frame of a camera that looks level, 1 m above the floor, with one object per box. Its horizon
// is the image's row 240; a box whose lower edge is `v` px below it has its foot at depth 500 / v
// m.
inline Sequence LevelSequence(const std::vector<Box>& boxes) {
  Sequence sequence;
  sequence.camera = {640, 480, 500.0, 500.0, 320.0, 240.0};
  sequence.frames.resize(1);
  const Plane floor_in_camera{-Eigen::Vector3d::UnitY(), 1.0};
  sequence.planes = {{0, floor_in_camera}};  // the camera's frame is the world's
  for (const Box& box : boxes) {
    const int object_index = static_cast<int>(sequence.objects.size());
    sequence.objects.push_back({object_index, "label", 0, {}});
    sequence.detections.push_back({0, object_index, 1.0, box, floor_in_camera, {}, {}});
  }
  return sequence;
}

}  // namespace soslam
