// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/batch.h"

namespace soslam {

// Rays from one origin, and where they first meet a surface.
struct RayBatch {
  BatchOfVectors direction;
  Batch depth;  // point = origin + depth * direction; not positive (maybe NaN) where there is none
  BatchOfVectors point;
  BatchOfVectors gradient;  // see BodySurface::Gradient
};

// The surface of a body in its own frame: F(x) = || (x / a, y / b, z / c) ||_q = 1 with
// 1 / p + 1 / q = 1, p the shape exponent of SupportFunction. p = 2 is the paper's quadric (eq.
// 13), p = 1 the cuboid, for which F is the largest of the three.
class BodySurface {
 public:
  BodySurface(const Eigen::Vector3d& half_axes, double shape_exponent);

  // Edges too sharp to tell from a cuboid's are a cuboid's.
  bool IsCuboid() const { return is_cuboid_; }

  // Where a ray first meets the surface: origin + depth * direction, depth > 0. None when the ray
  // misses, or the surface is behind the origin or around it.
  std::optional<double> Entry(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const;

  // The same for many rays: fills what comes after the directions.
  void Meet(const Eigen::Vector3d& origin, RayBatch* rays) const;

  // dF / dx at a surface point: along the outward normal, with Gradient(x) . x = 1. On an edge of
  // the cuboid, that of one of its faces.
  Eigen::Vector3d Gradient(const Eigen::Vector3d& point) const;

  // How Gradient changes: d gradient_i / d x_i, (others are 0 on the surface up to a multiple of
  // the gradient, which leaves the tangent plane gradient . x = 1 as it is) and the k of d
  // gradient_i / d log s_i = -k gradient_i.
  Eigen::Vector3d GradientByPoint(const Eigen::Vector3d& point) const;
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
