// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"

namespace soslam {

enum class Shape { kBox, kEllipsoid, kCylinder };
inline constexpr std::array kShapeNames = {"box", "ellipsoid", "cylinder"};  // in files
inline constexpr const auto& NamesOf(Shape) { return kShapeNames; }

// Exponents of the landmark that has this shape: an ellipsoid, the box around it, or the upright
// (elliptic) cylinder between them, with its axis along z.
ShapeExponents ExponentsOf(Shape shape);

// The factor by which a body whose half axes are 1 grows until its surface has the point.
double Gauge(const ShapeExponents& exponents, const Eigen::Vector3d& point);

// True if the point is inside the body or on its surface.
bool Contains(const Landmark& body, const Eigen::Vector3d& point);

// The outward unit normal at a surface point; both in the object frame.
Eigen::Vector3d OutwardNormal(const Landmark& body, const Eigen::Vector3d& point_in_object);

// The tight box around the silhouette of a body with the exponents of a Shape, exact where
// OutlineBox rounds edges, not cut at the image border. None unless the whole body is in front of
// the camera.
std::optional<Box> ExactOutline(const Camera& camera, const Landmark& body_in_camera);

}  // namespace soslam
