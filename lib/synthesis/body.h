// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

enum class Shape { kBox, kEllipsoid, kCylinder };
inline constexpr std::array kShapeNames = {"box", "ellipsoid", "cylinder"};  // in files

// A solid with the pose and half axes of a landmark: the ellipsoid itself, the box around it, or
// the upright (elliptic) cylinder between them, with its axis along z.
struct Body {
  Shape shape = Shape::kEllipsoid;
  Landmark landmark;
};

// The same body in the target frame.
Body Transform(const Rigid3d& target_from_source, const Body& body_in_source);

// Depth at which a ray from `origin`, outside the body, first meets it: origin + depth * direction,
// depth > 0. All in the body's frame. None when the ray misses.
std::optional<double> NearestIntersection(const Body& body, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction);

// Exponents of the superquadric that has this shape.
ShapeExponents ExponentsOf(Shape shape);

// The factor by which a body whose half axes are 1 grows until its surface has the point.
double Gauge(Shape shape, const Eigen::Vector3d& point);

// True if the point is inside the body or on its surface.
bool Contains(const Body& body, const Eigen::Vector3d& point);

// The outward unit normal at a surface point; both in the object frame.
Eigen::Vector3d OutwardNormal(const Body& body, const Eigen::Vector3d& point_in_object);

// The tight box around the silhouette of the body, exact, not cut at the image border. None unless
// the whole body is in front of the camera.
std::optional<Box> OutlineBox(const Camera& camera, const Body& body_in_camera);

}  // namespace soslam
