// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/iou.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace soslam {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;  // convex and planar
using Polyhedron = std::vector<Polygon>;       // the faces of a convex body

// Points closer to a cutting plane than this (in units of the clipping box's half axes) lie on it.
constexpr double kOnPlane = 1e-12;

// Keeps the part with side * point[axis] <= 1.
Polyhedron Clip(const Polyhedron& body, int axis, double side) {
  const auto excess = [&](const Eigen::Vector3d& point) { return side * point(axis) - 1.0; };
  const bool cuts = std::ranges::any_of(body, [&](const Polygon& face) {
    return std::ranges::any_of(
        face, [&](const Eigen::Vector3d& point) { return excess(point) > kOnPlane; });
  });
  if (!cuts) return body;

  Polyhedron clipped;
  Polygon cap;
  for (const Polygon& face : body) {
    Polygon kept;
    for (size_t i = 0; i < face.size(); ++i) {
      const Eigen::Vector3d& from = face[i];
      const Eigen::Vector3d& to = face[(i + 1) % face.size()];
      const double from_excess = excess(from);
      const double to_excess = excess(to);
      if (from_excess <= kOnPlane) kept.push_back(from);
      if (std::abs(from_excess) <= kOnPlane) cap.push_back(from);
      if ((from_excess > kOnPlane && to_excess < -kOnPlane) ||
          (from_excess < -kOnPlane && to_excess > kOnPlane)) {
        const double fraction = from_excess / (from_excess - to_excess);
        kept.push_back(from + fraction * (to - from));
        cap.push_back(kept.back());
      }
    }
    if (kept.size() >= 3) clipped.push_back(kept);
  }
  if (cap.size() >= 3) {
    // In order around its centre, in the plane orthogonal to the axis.
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& point : cap) centre += point / static_cast<double>(cap.size());
    std::ranges::sort(cap, {}, [&](const Eigen::Vector3d& point) {
      const Eigen::Vector3d offset = point - centre;
      return std::atan2(offset((axis + 2) % 3), offset((axis + 1) % 3));
    });
    clipped.push_back(cap);
  }
  return clipped;
}

// Sums the pyramids over the faces with their apex inside the body.
double Volume(const Polyhedron& body) {
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  size_t points = 0;
  for (const Polygon& face : body) {
    for (const auto& point : face) apex += point;
    points += face.size();
  }
  if (points == 0) return 0.0;
  apex /= static_cast<double>(points);
  double volume = 0.0;
  for (const Polygon& face : body) {
    for (size_t i = 1; i + 1 < face.size(); ++i) {
      volume += std::abs((face[0] - apex).dot((face[i] - apex).cross(face[i + 1] - apex))) / 6.0;
    }
  }
  return volume;
}

double BoxVolume(const Landmark& landmark) { return 8.0 * landmark.half_axes.prod(); }

}  // namespace

double IntersectionVolume(const Landmark& one, const Landmark& other) {
  // In the other box's frame, scaled so that it is the cube [-1, 1]^3.
  const Rigid3d other_from_one = other.frame_from_object.Inverse() * one.frame_from_object;
  Polyhedron body;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Polygon face;
      for (const auto& [u, v] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        Eigen::Vector3d corner;  // of the unit cube
        corner(axis) = side;
        corner((axis + 1) % 3) = u;
        corner((axis + 2) % 3) = v;
        face.emplace_back(
            (other_from_one * one.half_axes.cwiseProduct(corner)).cwiseQuotient(other.half_axes));
      }
      body.push_back(face);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) body = Clip(body, axis, side);
  }
  return Volume(body) * other.half_axes.prod();
}

double BoxIou(const Landmark& one, const Landmark& other) {
  const double intersection =
      std::min({IntersectionVolume(one, other), BoxVolume(one), BoxVolume(other)});
  const double iou = intersection / (BoxVolume(one) + BoxVolume(other) - intersection);
  return std::isfinite(iou) ? iou : 0.0;
}

}  // namespace soslam
