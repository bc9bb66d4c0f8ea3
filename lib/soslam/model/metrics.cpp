// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/metrics.h"

namespace soslam {

Rigid3d Alignment::Apply(const Rigid3d& world_from_camera) const {
  return truth_from_scaled *
         Rigid3d{world_from_camera.rotation, scale * world_from_camera.translation};
}

Landmark Alignment::Apply(const Landmark& landmark_in_world) const {
  Landmark moved = landmark_in_world;
  moved.half_axes *= scale;
  moved.frame_from_object = Apply(landmark_in_world.frame_from_object);
  return moved;
}

Plane Alignment::Apply(const Plane& plane_in_world) const {
  return Transform(truth_from_scaled, Plane{plane_in_world.normal, scale * plane_in_world.offset});
}

Alignment Alignment::Inverse() const {
  Alignment inverse;
  inverse.kind = kind;
  inverse.scale = 1.0 / scale;
  inverse.truth_from_scaled = truth_from_scaled.Inverse();
  inverse.truth_from_scaled.translation /= scale;
  return inverse;
}

}  // namespace soslam
