// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/landmark_tangent.h"

#include "geometry/rigid3.h"

namespace soslam {

Landmark Moved(const Landmark& landmark, const LandmarkStep& step) {
  Landmark moved = landmark;
  moved.frame_from_object.rotation =
      (ExpRotation(step.head<3>()) * landmark.frame_from_object.rotation).normalized();
  moved.frame_from_object.translation += step.segment<3>(3);
  moved.half_axes = landmark.half_axes.array() * step.tail<3>().array().exp();
  return moved;
}

}  // namespace soslam
