// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/wireframe.h"

namespace soslam {

using Polygon = std::vector<Eigen::Vector2d>;         // px, closed by its first point
using LineSegment2 = std::array<Eigen::Vector2d, 2>;  // px

Polygon CornersOf(const Box& box);

// The silhouette of the landmark in the image, from its corners or 90 directions; empty unless the
// whole landmark is in front of the camera.
Polygon OutlinePolygon(const Camera& camera, const Landmark& landmark_in_camera);

// The x axis through the landmark, from the centre of its back to that of its front, and the y and
// z axes from its centre to the centres of these faces; none unless all of these points are in
// front of the camera.
std::optional<std::array<LineSegment2, 3>> ProjectedAxes(const Camera& camera,
                                                         const Landmark& landmark_in_camera);

// The part of a segment that is farther than kNearM (m) in front of the camera. None if there is no
// such part.
inline constexpr double kNearM = 0.05;
std::optional<LineSegment2> ProjectSegment(const Camera& camera, const LineSegment3& in_camera);

// A square grid on a plane: lines in both directions, `cell` (m) apart.
struct Grid {
  double cell = 0.0;
  std::vector<LineSegment3> lines;
};

// The grid around points on or near a plane, in the plane's frame. Cells of half a metre, or of a
// multiple that keeps the number of lines within kMaxGridLines. `points` must not be empty.
inline constexpr int kMaxGridLines = 12;
Grid GridAround(const Plane& plane, const std::vector<Eigen::Vector3d>& points);

}  // namespace soslam
