// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/support_function.h"

namespace soslam {
namespace {

// Superquadrics with a larger q, which have sharper edges, are treated as cuboids.
constexpr double kLargestQ = 200.0;
constexpr int kMaxNewtonSteps = 30;
// Newton's method converges quadratically: after a step of this size the error is near rounding.
constexpr double kNewtonTolerance = 1e-8;

// Depths at which a ray's line enters and leaves the cuboid |x_i| <= 1; none when the line misses
// it, or the cuboid is behind the origin.
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

// |x|^exponent, exponent >= 0. For most shape exponents (1.1, 1.2, 1.4, 1.5) 2 q is an integer:
// products and a root then take a fraction of the time of logarithms.
double AbsolutePower(double x, double exponent) {
  constexpr double kRounding = 1e-12;  // of q = p / (p - 1)
  const double halves = std::round(2.0 * exponent);
  if (std::abs(2.0 * exponent - halves) > kRounding) return std::pow(std::abs(x), exponent);
  const int whole_halves = static_cast<int>(halves);
  double power = whole_halves % 2 == 1 ? std::sqrt(std::abs(x)) : 1.0;
  double squared = std::abs(x);
  for (int whole = whole_halves / 2; whole > 0; whole /= 2) {
    if (whole % 2 == 1) power *= squared;
    squared *= squared;
  }
  return power;
}

// Newton's step to F = 1 from F^q = 1 + u: q ((1 + u) - (1 + u)^(1 - 1 / q)) over the slope of F^q,
// as a series to the third power of u, which is not larger. F is closer to linear than F^q and
// convex as well, so that steps do not pass the root.
double StepToSurface(double excess, double slope, double q) {
  const double second = 0.5 * (1.0 - 1.0 / q);
  const double third = second / 3.0 * (1.0 + 1.0 / q);
  return excess * (1.0 + excess * (second - excess * third)) / -slope;
}

}  // namespace

double DualExponent(double shape_exponent) {
  const double q = shape_exponent / (shape_exponent - 1.0);
  return shape_exponent > 1.0 && q <= kLargestQ ? q : std::numeric_limits<double>::infinity();
}

BodySurface::BodySurface(const Eigen::Vector3d& half_axes, double shape_exponent)
    : inverse_axes_(half_axes.cwiseInverse()),
      q_(DualExponent(shape_exponent)),
      is_cuboid_(std::isinf(q_)) {}

std::optional<double> BodySurface::Entry(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) const {
  // Coordinates in which all half axes are 1.
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
  // c <= 0: the origin is inside, so the outside is not visible. half_b >= 0: the ray leads away.
  if (!(discriminant >= 0.0) || !(c > 0.0) || !(half_b < 0.0)) return std::nullopt;
  return c / (-half_b + std::sqrt(discriminant));
}

std::optional<double> BodySurface::SuperquadricEntry(const Eigen::Vector3d& origin,
                                                     const Eigen::Vector3d& direction) const {
  const auto interval = CuboidInterval(origin, direction);
  if (!interval) return std::nullopt;
  if (is_cuboid_) return interval->first > 0.0 ? std::optional(interval->first) : std::nullopt;
  // F is convex along the ray and at least 1 where it enters the cuboid: Newton's steps from there
  // approach the root without passing it. If the origin is inside the cuboid but outside the body,
  // they start at the origin.
  double depth = std::max(interval->first, 0.0);
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    double excess = -1.0;  // F^q - 1, at most 2
    double slope = 0.0;    // of F^q by the depth
    for (int k = 0; k < 3; ++k) {
      const double x = origin[k] + depth * direction[k];
      const double power = AbsolutePower(x, q_ - 2.0);
      excess += x * x * power;
      slope += q_ * x * power * direction[k];
    }
    if (depth == 0.0 && !(excess > 0.0)) return std::nullopt;  // the origin is inside
    if (!(slope < 0.0)) return std::nullopt;
    const double step = StepToSurface(excess, slope, q_);
    depth += step;
    if (!(depth < interval->second)) return std::nullopt;
    if (q_ * step < kNewtonTolerance * depth) return depth;  // F^q changes q times as fast as F
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
  return x.unaryExpr([this](double c) { return AbsolutePower(c, q_ - 2.0) * c; })
      .cwiseProduct(inverse_axes_);
}

Eigen::Vector3d BodySurface::GradientDerivatives(const Eigen::Vector3d& point) const {
  if (is_cuboid_) return Eigen::Vector3d::Zero();
  const Eigen::Array3d x = (point.array() * inverse_axes_.array()).abs();
  return ((q_ - 1.0) * x.pow(q_ - 2.0) * inverse_axes_.array().square()).matrix();
}

}  // namespace soslam
