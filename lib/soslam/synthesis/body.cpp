// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/body.h"

#include <algorithm>
#include <limits>

#include "soslam/geometry/surface.h"
#include "soslam/geometry/wireframe.h"

namespace soslam {
namespace {

Box Union(const Box& first, const Box& second) {
  return {std::min(first.x_min, second.x_min), std::min(first.y_min, second.y_min),
          std::max(first.x_max, second.x_max), std::max(first.y_max, second.y_max)};
}

}  // namespace

ShapeExponents ExponentsOf(Shape shape) {
  if (shape == Shape::kCylinder) return {kEllipsoidExponent, kCuboidExponent};
  return shape == Shape::kBox ? kCuboidExponent : kEllipsoidExponent;
}

double Gauge(const ShapeExponents& exponents, const Eigen::Vector3d& point) {
  return SuperquadricNorm(point, DualExponents(exponents)).value;
}

bool Contains(const Landmark& body, const Eigen::Vector3d& point) {
  const Eigen::Vector3d point_in_object = body.frame_from_object.Inverse() * point;
  return Gauge(body.shape_exponents, point_in_object.cwiseQuotient(body.half_axes)) <= 1.0;
}

Eigen::Vector3d OutwardNormal(const Landmark& body, const Eigen::Vector3d& point_in_object) {
  return BodySurface(body.half_axes, body.shape_exponents).Gradient(point_in_object).normalized();
}

std::optional<Box> ExactOutline(const Camera& camera, const Landmark& body_in_camera) {
  const ShapeExponents& exponents = body_in_camera.shape_exponents;
  if (exponents.HasAxis()) {
    // A cylinder is the convex hull of its two rims. A rim is a flat ellipsoid, and OutlineBox
    // handles it like any other.
    std::optional<Box> rims[2];
    for (int end = 0; end < 2; ++end) {
      Landmark rim = body_in_camera;
      const double height = (end == 0 ? -1.0 : 1.0) * body_in_camera.half_axes.z();
      rim.frame_from_object.translation =
          body_in_camera.frame_from_object * Eigen::Vector3d(0.0, 0.0, height);
      rim.half_axes.z() = 0.0;
      rim.shape_exponents = kEllipsoidExponent;
      rims[end] = OutlineBox(camera, rim);
    }
    if (!rims[0] || !rims[1]) return std::nullopt;
    return Union(*rims[0], *rims[1]);
  }
  if (exponents != kCuboidExponent) return OutlineBox(camera, body_in_camera);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const LineSegment3& edge : UnitCuboidEdges()) {
    for (const Eigen::Vector3d& corner : edge) {
      const auto pixel = camera.Project(PointAt(body_in_camera, corner));
      if (!pixel) return std::nullopt;
      box = Union(box, {pixel->x(), pixel->y(), pixel->x(), pixel->y()});
    }
  }
  return box;
}

}  // namespace soslam
