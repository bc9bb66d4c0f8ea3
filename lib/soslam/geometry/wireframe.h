// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"

namespace soslam {

// The point of a landmark, in the landmark's frame, at multiples of its half axes.
Eigen::Vector3d PointAt(const Landmark& landmark, const Eigen::Vector3d& multiples);

using LineSegment3 = std::array<Eigen::Vector3d, 2>;

// The edges of the cuboid |x_i| <= 1: four along x, four along y, four along z, each from -1 to 1.
std::array<LineSegment3, 12> UnitCuboidEdges();

// The edges of the landmark's cuboid that belong to a face which the camera sees.
std::vector<LineSegment3> VisibleCuboidEdges(const Landmark& landmark_in_camera);

// Points of the landmark that the camera sees on its silhouette, m: the tangent points in evenly
// spaced image directions, clockwise in the image from its x axis. Empty unless the whole landmark
// is in front of the camera.
std::vector<Eigen::Vector3d> SilhouettePoints(const Camera& camera,
                                              const Landmark& landmark_in_camera);

}  // namespace soslam
