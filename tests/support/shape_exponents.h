// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include "geometry/landmark.h"
#include "support/random.h"

namespace soslam {

// The cuboid, the ellipsoid, and bodies in between; 1.02 has almost the edges of a cuboid.
inline constexpr std::array kShapeExponents = {kCuboidExponent, 1.02, 1.1, 1.5, kEllipsoidExponent};

inline Landmark WithShape(Landmark landmark, double shape_exponent) {
  landmark.shape_exponent = shape_exponent;
  return landmark;
}

inline Eigen::Vector3d RandomDirection() { return RandomRotation() * Eigen::Vector3d::UnitX(); }

// || (x / a, y / b, z / c) ||_q, 1 / p + 1 / q = 1: 1 on the surface, less inside.
inline double SurfaceNorm(const Eigen::Vector3d& half_axes, double shape_exponent,
                          const Eigen::Vector3d& point_in_object) {
  const Eigen::Array3d x = point_in_object.cwiseQuotient(half_axes).cwiseAbs();
  if (shape_exponent == kCuboidExponent) return x.maxCoeff();
  const double q = shape_exponent / (shape_exponent - 1.0);
  return x.maxCoeff() * std::pow((x / x.maxCoeff()).pow(q).sum(), 1.0 / q);
}

// A surface point in the object frame, the likelier the more its surroundings bend: for the cuboid,
// always a corner.
inline Eigen::Vector3d RandomSurfacePoint(const Eigen::Vector3d& half_axes, double shape_exponent) {
  const Eigen::Array3d w = RandomDirection();
  const double exponent = 2.0 * (shape_exponent - 1.0) / shape_exponent;
  return half_axes.array() * w.abs().pow(exponent) * w.sign();
}

inline Eigen::Vector3d RandomSurfacePoint(const Landmark& landmark) {
  return landmark.frame_from_object *
         RandomSurfacePoint(landmark.half_axes, landmark.shape_exponent);
}

}  // namespace soslam
