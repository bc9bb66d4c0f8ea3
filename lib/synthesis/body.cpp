// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/wireframe.h"

namespace soslam {
namespace {

// A ray in the object frame, in units of the half axes, so that the body is the unit box, ball or
// cylinder. Depths are the same as along the original ray.
struct UnitRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

Eigen::Vector3d ToUnitBody(const Landmark& landmark, const Eigen::Vector3d& point) {
  const Rigid3d& pose = landmark.frame_from_object;
  return (pose.rotation.conjugate() * (point - pose.translation)).cwiseQuotient(landmark.half_axes);
}

// Depths at which a line enters and leaves a convex set; empty when enter > leave.
struct DepthInterval {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();

  DepthInterval Intersected(const DepthInterval& other) const {
    return {std::max(enter, other.enter), std::min(leave, other.leave)};
  }
};

constexpr DepthInterval kEmpty = {std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};

// The interval inside the slab |x_axis| <= 1.
DepthInterval InsideSlab(const UnitRay& ray, int axis) {
  const double origin = ray.origin[axis];
  const double direction = ray.direction[axis];
  if (direction == 0.0) return std::abs(origin) <= 1.0 ? DepthInterval{} : kEmpty;
  const double first = (-1.0 - origin) / direction;
  const double second = (1.0 - origin) / direction;
  return {std::min(first, second), std::max(first, second)};
}

// The interval inside the infinite cylinder x^2 + y^2 <= 1.
DepthInterval InsideTube(const UnitRay& ray) {
  const Eigen::Vector2d origin = ray.origin.head<2>();
  const Eigen::Vector2d direction = ray.direction.head<2>();
  const double a = direction.squaredNorm();
  const double half_b = origin.dot(direction);
  const double c = origin.squaredNorm() - 1.0;
  if (a == 0.0) return c <= 0.0 ? DepthInterval{} : kEmpty;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0.0) return kEmpty;
  const double root = std::sqrt(discriminant);
  return {(-half_b - root) / a, (-half_b + root) / a};
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

Body Transform(const Rigid3d& target_from_source, const Body& body_in_source) {
  return {body_in_source.shape, Transform(target_from_source, body_in_source.landmark)};
}

std::optional<double> NearestIntersection(const Body& body, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) {
  if (body.shape == Shape::kEllipsoid) {
    return NearestIntersection(body.landmark, origin, direction);
  }
  const Eigen::Quaterniond object_from_frame = body.landmark.frame_from_object.rotation.conjugate();
  const UnitRay ray = {ToUnitBody(body.landmark, origin),
                       (object_from_frame * direction).cwiseQuotient(body.landmark.half_axes)};
  DepthInterval inside = InsideSlab(ray, 2);
  if (body.shape == Shape::kCylinder) {
    inside = inside.Intersected(InsideTube(ray));
  } else {
    inside = inside.Intersected(InsideSlab(ray, 0)).Intersected(InsideSlab(ray, 1));
  }
  if (!(inside.enter > 0.0) || !(inside.enter <= inside.leave)) return std::nullopt;
  return inside.enter;
}

bool Contains(const Body& body, const Eigen::Vector3d& point) {
  const Eigen::Vector3d unit = ToUnitBody(body.landmark, point);
  switch (body.shape) {
    case Shape::kBox:
      return unit.cwiseAbs().maxCoeff() <= 1.0;
    case Shape::kEllipsoid:
      return unit.squaredNorm() <= 1.0;
    case Shape::kCylinder:
      return unit.head<2>().squaredNorm() <= 1.0 && std::abs(unit.z()) <= 1.0;
  }
  return false;
}

Eigen::Vector3d OutwardNormal(const Body& body, const Eigen::Vector3d& point_in_object) {
  const Eigen::Vector3d& half_axes = body.landmark.half_axes;
  const Eigen::Vector3d unit = point_in_object.cwiseQuotient(half_axes);
  if (body.shape == Shape::kEllipsoid) return unit.cwiseQuotient(half_axes).normalized();
  if (body.shape == Shape::kCylinder && std::abs(unit.z()) < unit.head<2>().norm()) {
    return Eigen::Vector3d(unit.x() / half_axes.x(), unit.y() / half_axes.y(), 0.0).normalized();
  }
  int face = 2;
  if (body.shape == Shape::kBox) unit.cwiseAbs().maxCoeff(&face);
  return Eigen::Vector3d::Unit(face) * (unit[face] < 0.0 ? -1.0 : 1.0);
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
