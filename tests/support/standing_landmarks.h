// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include "soslam/constraints/parameters.h"
#include "support/random.h"

namespace soslam {

// A landmark of any yaw that stands upright on a plane.
inline Landmark RandomStanding(const Plane& plane) {
  Landmark landmark;
  landmark.half_axes = RandomVector(0.01, 1.0);
  landmark.frame_from_object.rotation = UprightRotation(plane.normal, RandomUniform(-3, 3));
  const Eigen::Vector3d anywhere = RandomVector(-3, 3);
  landmark.frame_from_object.translation =
      anywhere + (landmark.half_axes.z() - plane.SignedDistance(anywhere)) * plane.normal;
  return landmark;
}

// Half axes 1, 2, 3, lying with the x axis up, its centre 5 m over the floor z = 0.
inline Landmark LyingLandmark() {
  return {{Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY())),
           {7, 8, 5}},
          {1, 2, 3}};
}

}  // namespace soslam
