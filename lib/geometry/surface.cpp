// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/support_function.h"

namespace soslam {
namespace {

// Sharper edges than this are those of a cuboid.
constexpr double kLargestQ = 200.0;
constexpr int kMaxNewtonSteps = 30;
constexpr double kNewtonTolerance = 1e-13;

// The part of a ray's line inside the cuboid |x_i| <= 1; none when the line misses it, or the
// cuboid is behind the origin.
std::optional<std::pair<double, double>> CuboidInterval(const Eigen::Vector3d& origin,
                                                        const Eigen::Vector3d& direction) {
  double entry = -std::numeric_limits<double>::infinity();
  double exit = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0.0) {
      if (std::abs(origin[i]) > 1.0) return std::nullopt;
      continue;
    }
    const double one = (-1.0 - origin[i]) / direction[i];
    const double other = (1.0 - origin[i]) / direction[i];
    entry = std::max(entry, std::min(one, other));
    exit = std::min(exit, std::max(one, other));
  }
  if (!(entry < exit) || !(exit > 0.0)) return std::nullopt;
  return std::pair(entry, exit);
}

}  // namespace

BodySurface::BodySurface(const Eigen::Vector3d& half_axes, double shape_exponent)
    : inverse_axes_(half_axes.cwiseInverse()),
      q_(shape_exponent > 1.0 ? shape_exponent / (shape_exponent - 1.0)
                              : std::numeric_limits<double>::infinity()),
      is_cuboid_(q_ > kLargestQ) {}

std::optional<double> BodySurface::Entry(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) const {
  // With half axes of one.
  const Eigen::Vector3d o = origin.cwiseProduct(inverse_axes_);
  const Eigen::Vector3d d = direction.cwiseProduct(inverse_axes_);
  return q_ == kEllipsoidExponent ? QuadricEntry(o, d) : SuperquadricEntry(o, d);
}

std::optional<double> BodySurface::QuadricEntry(const Eigen::Vector3d& origin,
                                                const Eigen::Vector3d& direction) const {
  const double a = direction.squaredNorm();
  const double half_b = origin.dot(direction);
  const double c = origin.squaredNorm() - 1.0;
  const double discriminant = half_b * half_b - a * c;
  // c <= 0: the origin is inside, so there is no visible outside. half_b >= 0: the ray leads away.
  if (!(discriminant >= 0.0) || !(c > 0.0) || !(half_b < 0.0)) return std::nullopt;
  return c / (-half_b + std::sqrt(discriminant));
}

std::optional<double> BodySurface::SuperquadricEntry(const Eigen::Vector3d& origin,
                                                     const Eigen::Vector3d& direction) const {
  const auto interval = CuboidInterval(origin, direction);
  if (!interval) return std::nullopt;
  if (is_cuboid_) return interval->first > 0.0 ? std::optional(interval->first) : std::nullopt;
  // F is convex along the ray and at least 1 where it enters the cuboid: Newton's steps from there
  // approach the root without passing it. They start at the origin when the cuboid, but not the
  // body, is around it.
  double depth = std::max(interval->first, 0.0);
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const Eigen::Array3d x = (origin + depth * direction).array();
    const Eigen::Array3d ratio = x.abs() / x.abs().maxCoeff();
    const double norm = x.abs().maxCoeff() * std::pow(ratio.pow(q_).sum(), 1.0 / q_);
    if (depth == 0.0 && !(norm > 1.0)) return std::nullopt;  // the origin is inside
    const double slope = ((x.abs() / norm).pow(q_ - 1.0) * x.sign() * direction.array()).sum();
    if (!(slope < 0.0)) return std::nullopt;
    const double step = (norm - 1.0) / -slope;
    depth += step;
    if (!(depth < interval->second)) return std::nullopt;
    if (step < kNewtonTolerance * depth) return depth;
  }
  return std::nullopt;  // the ray grazes the surface
}

Eigen::Vector3d BodySurface::Gradient(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d x = point.cwiseProduct(inverse_axes_);
  if (q_ == kEllipsoidExponent) return x.cwiseProduct(inverse_axes_);
  if (is_cuboid_) {
    Eigen::Index face = 0;
    x.cwiseAbs().maxCoeff(&face);
    return Eigen::Vector3d::Unit(face) * std::copysign(inverse_axes_[face], x[face]);
  }
  return (x.array().abs().pow(q_ - 1.0) * x.array().sign() * inverse_axes_.array()).matrix();
}

Eigen::Vector3d BodySurface::GradientByPoint(const Eigen::Vector3d& point) const {
  if (is_cuboid_) return Eigen::Vector3d::Zero();
  const Eigen::Array3d x = (point.array() * inverse_axes_.array()).abs();
  return ((q_ - 1.0) * x.pow(q_ - 2.0) * inverse_axes_.array().square()).matrix();
}

}  // namespace soslam
