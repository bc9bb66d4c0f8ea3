// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/body.h"

#include <algorithm>
#include <limits>

#include "geometry/surface.h"
#include "geometry/wireframe.h"

namespace soslam {
namespace {

Landmark SuperquadricOf(const Body& body) {
  Landmark landmark = body.landmark;
  landmark.shape_exponents = ExponentsOf(body.shape);
  return landmark;
}

Box Union(const Box& first, const Box& second) {
  return {std::min(first.x_min, second.x_min), std::min(first.y_min, second.y_min),
          std::max(first.x_max, second.x_max), std::max(first.y_max, second.y_max)};
}

std::optional<Box> CuboidOutline(const Camera& camera, const Landmark& landmark_in_camera) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box = {kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const LineSegment3& edge : UnitCuboidEdges()) {
    for (const Eigen::Vector3d& corner : edge) {
      const auto pixel = camera.Project(PointAt(landmark_in_camera, corner));
      if (!pixel) return std::nullopt;
      box = Union(box, {pixel->x(), pixel->y(), pixel->x(), pixel->y()});
    }
  }
  return box;
}

// A cylinder is the convex hull of its two rims. A rim is a flat ellipsoid, and OutlineBox handles
// it like any other.
std::optional<Box> CylinderOutline(const Camera& camera, const Landmark& landmark_in_camera) {
  std::optional<Box> rims[2];
  for (int end = 0; end < 2; ++end) {
    Landmark rim = landmark_in_camera;
    const double height = (end == 0 ? -1.0 : 1.0) * landmark_in_camera.half_axes.z();
    rim.frame_from_object.translation =
        landmark_in_camera.frame_from_object * Eigen::Vector3d(0.0, 0.0, height);
    rim.half_axes.z() = 0.0;
    rims[end] = OutlineBox(camera, rim);
  }
  if (!rims[0] || !rims[1]) return std::nullopt;
  return Union(*rims[0], *rims[1]);
}

}  // namespace

ShapeExponents ExponentsOf(Shape shape) {
  if (shape == Shape::kCylinder) return {kEllipsoidExponent, kCuboidExponent};
  return shape == Shape::kBox ? kCuboidExponent : kEllipsoidExponent;
}

Body Transform(const Rigid3d& target_from_source, const Body& body_in_source) {
  return {body_in_source.shape, Transform(target_from_source, body_in_source.landmark)};
}

std::optional<double> NearestIntersection(const Body& body, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) {
  return NearestIntersection(SuperquadricOf(body), origin, direction);
}

double Gauge(Shape shape, const Eigen::Vector3d& point) {
  return SuperquadricNorm(point, DualExponents(ExponentsOf(shape))).value;
}

bool Contains(const Body& body, const Eigen::Vector3d& point) {
  const Eigen::Vector3d point_in_object = body.landmark.frame_from_object.Inverse() * point;
  return Gauge(body.shape, point_in_object.cwiseQuotient(body.landmark.half_axes)) <= 1.0;
}

Eigen::Vector3d OutwardNormal(const Body& body, const Eigen::Vector3d& point_in_object) {
  return BodySurface(body.landmark.half_axes, ExponentsOf(body.shape))
      .Gradient(point_in_object)
      .normalized();
}

std::optional<Box> OutlineBox(const Camera& camera, const Body& body_in_camera) {
  switch (body_in_camera.shape) {
    case Shape::kBox:
      return CuboidOutline(camera, body_in_camera.landmark);
    case Shape::kEllipsoid:
      return OutlineBox(camera, body_in_camera.landmark);
    case Shape::kCylinder:
      return CylinderOutline(camera, body_in_camera.landmark);
  }
  return std::nullopt;
}

}  // namespace soslam
