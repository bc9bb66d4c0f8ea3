// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include "soslam/geometry/landmark.h"
#include "soslam/geometry/wireframe.h"
#include "support/random.h"

namespace soslam {

// The cuboid, the ellipsoid, and bodies in between; 1.02 has almost the edges of a cuboid. Then
// bodies about a vertical axis: a cylinder, one with rounded rims, any, and
// domes over sharp and rounded rectangles.
inline constexpr std::array kShapeExponents = {ShapeExponents(kCuboidExponent),
                                               ShapeExponents(1.02),
                                               ShapeExponents(1.1),
                                               ShapeExponents(1.5),
                                               ShapeExponents(kEllipsoidExponent),
                                               ShapeExponents(2.0, 1.0),
                                               ShapeExponents(2.0, 1.1),
                                               ShapeExponents(1.3, 1.7),
                                               ShapeExponents(1.0, 1.5),
                                               ShapeExponents(1.1, 2.0)};

inline std::ostream& operator<<(std::ostream& stream, const ShapeExponents& exponents) {
  return stream << exponents.horizontal << ", " << exponents.vertical;
}

inline Landmark WithShape(Landmark landmark, const ShapeExponents& exponents) {
  landmark.shape_exponents = exponents;
  return landmark;
}

inline Eigen::Vector3d RandomDirection() { return RandomRotation() * Eigen::Vector3d::UnitX(); }

// || (x, y) ||_q for the exponent p, 1 / p + 1 / q = 1.
inline double DualNorm(double x, double y, double p) {
  if (p == kCuboidExponent) return std::max(std::abs(x), std::abs(y));
  const double q = p / (p - 1.0);
  return std::pow(std::pow(std::abs(x), q) + std::pow(std::abs(y), q), 1.0 / q);
}

// || ( || (x / a, y / b) ||, z / c ) || by the dual exponents: 1 on the surface, less inside.
inline double SurfaceNorm(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                          const Eigen::Vector3d& point_in_object) {
  const Eigen::Vector3d x = point_in_object.cwiseQuotient(half_axes);
  return DualNorm(DualNorm(x.x(), x.y(), exponents.horizontal), x.z(), exponents.vertical);
}

// A surface point in the object frame, the likelier the more its surroundings bend: for the cuboid,
// always a corner.
inline Eigen::Vector3d RandomSurfacePoint(const Eigen::Vector3d& half_axes,
                                          const ShapeExponents& exponents) {
  const auto power = [](double x, double p) {
    return std::copysign(std::pow(std::abs(x), 2.0 * (p - 1.0) / p), x);
  };
  const double latitude = std::asin(RandomDirection().z());
  const double longitude = RandomUniform(0.0, 2.0 * std::numbers::pi);
  const double rim = power(std::cos(latitude), exponents.vertical);
  return {half_axes.x() * rim * power(std::cos(longitude), exponents.horizontal),
          half_axes.y() * rim * power(std::sin(longitude), exponents.horizontal),
          half_axes.z() * power(std::sin(latitude), exponents.vertical)};
}

inline Eigen::Vector3d RandomSurfacePoint(const Landmark& landmark) {
  return landmark.frame_from_object *
         RandomSurfacePoint(landmark.half_axes, landmark.shape_exponents);
}

// The eight corners of a cuboid, in the frame that the landmark is given in.
inline std::vector<Eigen::Vector3d> CornersOf(const Landmark& cuboid) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    corners.push_back(PointAt(cuboid, signs));
  }
  return corners;
}

// The tight box around the corners in TestCamera's image: OutlineBox rounds corners off.
inline Box BoxAroundCorners(const Landmark& cuboid_in_camera) {
  Eigen::AlignedBox2d around;
  for (const Eigen::Vector3d& corner : CornersOf(cuboid_in_camera)) {
    around.extend(*TestCamera().Project(corner));
  }
  return {around.min().x(), around.min().y(), around.max().x(), around.max().y()};
}

}  // namespace soslam
