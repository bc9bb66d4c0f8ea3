// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "soslam/geometry/support_function.h"

namespace soslam {

// The surface of a body in its own frame: F(x) = || (x / a, y / b, z / c) || = 1 by the
// SuperquadricNorm with the DualExponents. The paper's quadric (eq. 13) for exponents of 2; for the
// cuboid F is the largest |component|.
class BodySurface {
 public:
  BodySurface(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents);

  // Depth at which a ray first meets the surface: origin + depth * direction, depth > 0. None when
  // the ray misses, or the surface is behind the origin or around it.
  std::optional<double> Entry(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const;

  // dF / dx at a surface point: along the outward normal, with Gradient(x) . x = 1. On an edge of
  // a body that has edges, the gradient of one of its faces.
  Eigen::Vector3d Gradient(const Eigen::Vector3d& point) const;

  // d^2 F / dx^2. With the half axes, the gradient changes by
  // d gradient / d log s = -diag(gradient) - Hessian(x) diag(x).
  Eigen::Matrix3d Hessian(const Eigen::Vector3d& point) const;

 private:
  std::optional<double> SuperquadricEntry(const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) const;

  Eigen::Vector3d inverse_axes_;
  ShapeExponents dual_;
};

}  // namespace soslam
