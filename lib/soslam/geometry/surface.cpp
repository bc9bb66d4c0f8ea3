// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace soslam {
namespace {

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

// Depth at which the ray enters the unit sphere.
std::optional<double> SphereEntry(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double a = direction.squaredNorm();
  const double half_b = origin.dot(direction);
  const double c = origin.squaredNorm() - 1.0;
  const double discriminant = half_b * half_b - a * c;
  // c <= 0: the origin is inside, so the outside is not visible. half_b >= 0: the ray leads away.
  if (!(discriminant >= 0.0) || !(c > 0.0) || !(half_b < 0.0)) return std::nullopt;
  return c / (-half_b + std::sqrt(discriminant));
}

// F^q - 1 inside the unit cuboid and its slope along a direction, for the q that needs the fewest
// powers. Flat faces of the body are faces of the cuboid, which the ray has met before: F here is
// that of the curved surface between them.
struct PowerOfF {
  double excess;
  double slope;
  double q;
};

PowerOfF PowerAlong(const Eigen::Vector3d& x, const Eigen::Vector3d& direction,
                    const ShapeExponents& dual) {
  const bool has_caps = std::isinf(dual.vertical);
  double section = 0.0;  // the norm of (x, y), to the power of its exponent
  double section_slope = 0.0;
  double exponent = dual.horizontal;
  if (std::isinf(exponent)) {
    if (has_caps) return {0.0, 0.0, 1.0};
    const int side = std::abs(x.x()) >= std::abs(x.y()) ? 0 : 1;
    exponent = 1.0;
    section = std::abs(x[side]);
    section_slope = x[side] < 0.0 ? -direction[side] : direction[side];
  } else {
    for (const int i : {0, 1}) {
      const double power = AbsolutePower(x[i], exponent - 2.0);
      section += x[i] * x[i] * power;
      section_slope += exponent * x[i] * power * direction[i];
    }
  }
  if (has_caps) return {section - 1.0, section_slope, exponent};
  const double ratio = dual.vertical / exponent;
  const double outer = section > 0.0 ? AbsolutePower(section, ratio - 1.0) : 0.0;
  const double along_axis = AbsolutePower(x.z(), dual.vertical - 2.0);
  return {section * outer + x.z() * x.z() * along_axis - 1.0,
          ratio * outer * section_slope + dual.vertical * x.z() * along_axis * direction.z(),
          dual.vertical};
}

// Newton's step to F = 1 from F^q = 1 + u: q ((1 + u) - (1 + u)^(1 - 1 / q)) over the slope of F^q;
// for u up to 2 as a series to its third power, which is not larger. F is closer to linear than F^q
// and convex as well, so that steps do not pass the root.
double StepToSurface(double excess, double slope, double q) {
  if (excess > 2.0) return q * (1.0 + excess - std::pow(1.0 + excess, 1.0 - 1.0 / q)) / -slope;
  const double second = 0.5 * (1.0 - 1.0 / q);
  const double third = second / 3.0 * (1.0 + 1.0 / q);
  return excess * (1.0 + excess * (second - excess * third)) / -slope;
}

}  // namespace

BodySurface::BodySurface(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents)
    : inverse_axes_(half_axes.cwiseInverse()), dual_(DualExponents(exponents)) {}

std::optional<double> BodySurface::Entry(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) const {
  // Coordinates in which all half axes are 1.
  const Eigen::Vector3d o = origin.cwiseProduct(inverse_axes_);
  const Eigen::Vector3d d = direction.cwiseProduct(inverse_axes_);
  return dual_ == kEllipsoidExponent ? SphereEntry(o, d) : SuperquadricEntry(o, d);
}

std::optional<double> BodySurface::SuperquadricEntry(const Eigen::Vector3d& origin,
                                                     const Eigen::Vector3d& direction) const {
  const auto interval = CuboidInterval(origin, direction);
  if (!interval) return std::nullopt;
  // F is convex along the ray and at least 1 where it enters the cuboid: Newton's steps from there
  // approach the root without passing it. If the origin is inside the cuboid but outside the body,
  // they start at the origin.
  double depth = std::max(interval->first, 0.0);
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const PowerOfF power = PowerAlong(origin + depth * direction, direction, dual_);
    if (i == 0 && !(power.excess > 0.0)) {  // a flat face, or the origin is inside
      return depth > 0.0 ? std::optional(depth) : std::nullopt;
    }
    if (!(power.slope < 0.0)) return std::nullopt;
    const double step = StepToSurface(power.excess, power.slope, power.q);
    depth += step;
    if (!(depth < interval->second)) return std::nullopt;
    // F^q changes q times as fast as F.
    if (power.q * step < kNewtonTolerance * depth) return depth;
  }
  return std::nullopt;  // the ray grazes the surface
}

Eigen::Vector3d BodySurface::Gradient(const Eigen::Vector3d& point) const {
  const Eigen::Array3d slopes = SuperquadricNorm(point.cwiseProduct(inverse_axes_), dual_).slopes;
  return slopes.matrix().cwiseProduct(inverse_axes_);
}

Eigen::Matrix3d BodySurface::Hessian(const Eigen::Vector3d& point) const {
  Eigen::Matrix3d by_u;
  SuperquadricNorm(point.cwiseProduct(inverse_axes_), dual_, &by_u);
  return inverse_axes_.asDiagonal() * by_u * inverse_axes_.asDiagonal();
}

}  // namespace soslam
