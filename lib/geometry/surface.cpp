// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/wide_loops.h"
#include "geometry/support_function.h"

namespace soslam {
namespace {

// Superquadrics with a larger q, which have sharper edges, are treated as cuboids.
constexpr double kLargestQ = 200.0;
constexpr int kMaxNewtonSteps = 30;
constexpr double kNewtonTolerance = 1e-13;
// Newton's method converges quadratically: after a step of this size the error is near rounding.
constexpr double kBatchNewtonTolerance = 1e-8;

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

// QuadricEntry and Gradient for many rays.
SOSLAM_MULTIVERSION void MeetQuadric(const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& inverse_axes, RayBatch* rays) {
  // Coordinates in which all half axes are 1.
  const Eigen::Vector3d o = origin.cwiseProduct(inverse_axes);
  const double c = o.squaredNorm() - 1.0;
  for (int at = 0; at < kBatchSize; at += 4) {
    ThreeFours direction;
    Four a{}, half_b{}, root;
    for (int i = 0; i < 3; ++i) {
      Load(rays->direction[i].data() + at, &direction[i]);
      const Four d = inverse_axes[i] * direction[i];
      a += d * d;
      half_b += o[i] * d;
    }
    SquareRoot(half_b * half_b - a * c, &root);
    // NaN for a ray that misses, negative for one that leads away or if the origin is inside.
    Four depth = Four{} - 1.0;
    if (c > 0.0) depth = c / (root - half_b);
    Store(depth, rays->depth.data() + at);
    for (int i = 0; i < 3; ++i) {
      const Four point = origin[i] + depth * direction[i];
      Store(point, rays->point[i].data() + at);
      Store((inverse_axes[i] * inverse_axes[i]) * point, rays->gradient[i].data() + at);
    }
  }
}

// CuboidInterval for many rays: a ray hits if entry < exit and exit > 0.
struct CuboidIntervals {
  CuboidIntervals(const Eigen::Vector3d& origin, const BatchOfVectors& direction) {
    for (size_t i = 0; i < 3; ++i) {
      const double o = origin[static_cast<Eigen::Index>(i)];
      const Batch one = (-1.0 - o) / direction[i];
      const Batch other = (1.0 - o) / direction[i];
      entry = entry.max(one.min(other));
      exit = exit.min(one.max(other));
    }
  }

  bool IsHit(int i) const { return entry[i] < exit[i] && exit[i] > 0.0; }

  Batch entry = Batch::Constant(-std::numeric_limits<double>::infinity());
  Batch exit = Batch::Constant(std::numeric_limits<double>::infinity());
};

// Rays whose intersection is not found yet: the first `count` elements of each array.
struct OpenRays {
  void Add(int number, const BatchOfVectors& directions, int from, double at, double until) {
    ray[static_cast<size_t>(count)] = number;
    for (size_t k = 0; k < 3; ++k) direction[k][count] = directions[k][from];
    depth[count] = at;
    exit[count] = until;
    ++count;
  }
  // The count padded to whole SIMD steps, so that the result of a ray does not depend on its place.
  int PaddedCount() const { return (count + 7) / 8 * 8; }

  int count = 0;
  std::array<int, kBatchSize> ray{};  // number in the batch
  BatchOfVectors direction = {Batch::Zero(), Batch::Zero(), Batch::Zero()};
  Batch depth = Batch::Zero();
  Batch exit = Batch::Zero();
};

using NumbersOfRays = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBatchSize, 1>;

// |x|^exponent, exponent >= 0. For most shape exponents (1.1, 1.2, 1.4, 1.5) 2 q is an integer:
// products and a root then take a fraction of the time of logarithms.
NumbersOfRays AbsolutePower(const NumbersOfRays& x, double exponent) {
  constexpr double kRounding = 1e-12;  // of q = p / (p - 1)
  const double halves = std::round(2.0 * exponent);
  if (std::abs(2.0 * exponent - halves) > kRounding) {
    return (exponent * (x.abs() + std::numeric_limits<double>::min()).log()).exp();
  }
  auto whole = static_cast<int>(halves) / 2;
  NumbersOfRays power = NumbersOfRays::Ones(x.size());
  if (static_cast<int>(halves) % 2 == 1) power = x.abs().sqrt();
  for (NumbersOfRays squared = x.abs(); whole > 0; whole /= 2) {
    if (whole % 2 == 1) power *= squared;
    squared *= squared;
  }
  return power;
}

// F^q along rays inside the cuboid, in coordinates in which all half axes are 1.
struct PowersAlongRays {
  PowersAlongRays(const Eigen::Vector3d& origin, const OpenRays& rays, double q) {
    const int size = rays.PaddedCount();
    excess.setConstant(size, -1.0);
    slope.setZero(size);
    for (size_t k = 0; k < 3; ++k) {
      const auto direction = rays.direction[k].head(size);
      x[k] = origin[static_cast<Eigen::Index>(k)] + rays.depth.head(size) * direction;
      power[k] = AbsolutePower(x[k], q - 2.0);
      excess += x[k].square() * power[k];
      slope += q * x[k] * power[k] * direction;
    }
  }

  std::array<NumbersOfRays, 3> x;
  std::array<NumbersOfRays, 3> power;  // |x_k|^(q - 2): shared by F^q, its slope and the gradient
  NumbersOfRays excess;                // F^q - 1, at most 2
  NumbersOfRays slope;                 // derivative of F^q by depth
};

// Newton's step to F = 1 from F^q = 1 + u: q ((1 + u) - (1 + u)^(1 - 1 / q)) over the slope of F^q,
// as a series to the third power of u, which is not larger. F is closer to linear than F^q and
// convex as well, so that steps do not pass the root.
double StepToSurface(double excess, double slope, double q) {
  const double second = 0.5 * (1.0 - 1.0 / q);
  const double third = second / 3.0 * (1.0 + 1.0 / q);
  return excess * (1.0 + excess * (second - excess * third)) / -slope;
}

// SuperquadricEntry and Gradient for many rays. The depth of a ray that misses is -1.
void MeetSuperquadric(const Eigen::Vector3d& origin, const BatchOfVectors& direction, double q,
                      Batch* depth, BatchOfVectors* gradient) {
  const CuboidIntervals interval(origin, direction);
  depth->setConstant(-1.0);
  for (Batch& component : *gradient) component.setZero();
  OpenRays rays;
  for (int i = 0; i < kBatchSize; ++i) {
    if (interval.IsHit(i)) {
      rays.Add(i, direction, i, std::max(interval.entry[i], 0.0), interval.exit[i]);
    }
  }
  // Rays that are still open after the last step graze the surface.
  for (int step = 0; step < kMaxNewtonSteps && rays.count > 0; ++step) {
    const PowersAlongRays at(origin, rays, q);
    const int count = std::exchange(rays.count, 0);
    for (int i = 0; i < count; ++i) {
      const bool is_inside = rays.depth[i] == 0.0 && !(at.excess[i] > 0.0);
      const double by = StepToSurface(at.excess[i], at.slope[i], q);
      const double next = rays.depth[i] + by;
      if (is_inside || !(at.slope[i] < 0.0) || !(next < rays.exit[i])) continue;
      const int ray = rays.ray[static_cast<size_t>(i)];
      if (!(q * by < kBatchNewtonTolerance * next)) {  // F^q changes q times as fast as F
        rays.Add(ray, rays.direction, i, next, rays.exit[i]);
        continue;
      }
      (*depth)[ray] = next;
      for (size_t k = 0; k < 3; ++k) {
        (*gradient)[k][ray] = at.power[k][i] * (at.x[k][i] + (q - 1.0) * by * rays.direction[k][i]);
      }
    }
  }
}

}  // namespace

BodySurface::BodySurface(const Eigen::Vector3d& half_axes, double shape_exponent)
    : inverse_axes_(half_axes.cwiseInverse()),
      q_(shape_exponent > 1.0 ? shape_exponent / (shape_exponent - 1.0)
                              : std::numeric_limits<double>::infinity()),
      is_cuboid_(q_ > kLargestQ) {}

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
    const Eigen::Array3d x = (origin + depth * direction).array();
    const double largest = x.abs().maxCoeff();
    const Eigen::Array3d ratio = x.abs() / largest;
    // r^q = r r^(q - 1): one power serves the norm and its derivative.
    const Eigen::Array3d power = ratio.pow(q_ - 1.0);
    const double sum = (ratio * power).sum();
    const double root = std::pow(sum, 1.0 / q_);
    const double norm = largest * root;
    if (depth == 0.0 && !(norm > 1.0)) return std::nullopt;  // the origin is inside
    const double slope = root / sum * (power * x.sign() * direction.array()).sum();
    if (!(slope < 0.0)) return std::nullopt;
    const double step = (norm - 1.0) / -slope;
    depth += step;
    if (!(depth < interval->second)) return std::nullopt;
    if (step < kNewtonTolerance * depth) return depth;
  }
  return std::nullopt;  // the ray grazes the surface
}

void BodySurface::Meet(const Eigen::Vector3d& origin, RayBatch* rays) const {
  if (q_ == kEllipsoidExponent) {
    MeetQuadric(origin, inverse_axes_, rays);
    return;
  }
  // Coordinates in which all half axes are 1.
  const Eigen::Vector3d o = origin.cwiseProduct(inverse_axes_);
  BatchOfVectors d;
  for (size_t i = 0; i < 3; ++i) {
    d[i] = inverse_axes_[static_cast<Eigen::Index>(i)] * rays->direction[i];
  }
  if (is_cuboid_) {
    const CuboidIntervals interval(o, d);
    for (int i = 0; i < kBatchSize; ++i) {
      rays->depth[i] = interval.IsHit(i) ? interval.entry[i] : -1.0;
    }
  } else {
    MeetSuperquadric(o, d, q_, &rays->depth, &rays->gradient);
  }
  for (size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    rays->point[i] = origin[axis] + rays->depth * rays->direction[i];
    if (!is_cuboid_) rays->gradient[i] *= inverse_axes_[axis];
  }
  for (int i = 0; i < kBatchSize && is_cuboid_; ++i) {
    const Eigen::Vector3d gradient =
        Gradient({rays->point[0][i], rays->point[1][i], rays->point[2][i]});
    for (size_t k = 0; k < 3; ++k) {
      rays->gradient[k][i] = gradient[static_cast<Eigen::Index>(k)];
    }
  }
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
