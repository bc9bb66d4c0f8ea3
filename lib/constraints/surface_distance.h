// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/landmark.h"
#include "geometry/mirror_mapping.h"

namespace soslam {

// Signed distance (m) of a point from a landmark's surface, to first order: (F - 1) / |dF / dx|,
// with the body F = || (x / a, y / b, z / c) ||_q <= 1 of BodySurface. Positive outside. That of a
// cuboid is the distance from a face's plane. Exact at the surface, to second order near it; far
// from it, an underestimate. At the centre, where F has no gradient, the negative of the shortest
// half axis, with derivatives of zero. All in one frame; `jacobian` and `normal`, the outward unit
// normal of the level surface through the point, may be null.
double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal = nullptr);

}  // namespace soslam
