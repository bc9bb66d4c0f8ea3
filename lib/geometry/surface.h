// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

namespace soslam {

// q of 1 / p + 1 / q = 1, p the shape exponent of SupportFunction. Infinite for the cuboid, p = 1,
// and for superquadrics whose edges are too sharp to distinguish from it.
double DualExponent(double shape_exponent);

// The surface of a body in its own frame: F(x) = || (x / a, y / b, z / c) ||_q = 1, q the
// DualExponent of p. p = 2 is the paper's quadric (eq. 13), p = 1 the cuboid, for which F is the
// largest |component|.
class BodySurface {
 public:
  BodySurface(const Eigen::Vector3d& half_axes, double shape_exponent);

  // True for the cuboid and for superquadrics whose edges are too sharp to distinguish from it.
  bool IsCuboid() const { return is_cuboid_; }

  // Depth at which a ray first meets the surface: origin + depth * direction, depth > 0. None when
  // the ray misses, or the surface is behind the origin or around it.
  std::optional<double> Entry(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const;

  // dF / dx at a surface point: along the outward normal, with Gradient(x) . x = 1. On an edge of
  // the cuboid, the gradient of one of its faces.
  Eigen::Vector3d Gradient(const Eigen::Vector3d& point) const;

  // Derivatives of Gradient: d gradient_i / d x_i (mixed ones are 0 on the surface up to a multiple
  // of the gradient, which leaves the tangent plane gradient . x = 1 unchanged), and the factor k
  // of d gradient_i / d log s_i = -k gradient_i, s the half axes.
  Eigen::Vector3d GradientDerivatives(const Eigen::Vector3d& point) const;
  double GradientByLogHalfAxes() const { return is_cuboid_ ? 1.0 : q_; }

 private:
  std::optional<double> QuadricEntry(const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction) const;
  std::optional<double> SuperquadricEntry(const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) const;

  Eigen::Vector3d inverse_axes_;
  double q_;
  bool is_cuboid_;
};

}  // namespace soslam
