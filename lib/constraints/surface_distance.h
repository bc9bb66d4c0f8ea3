// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/landmark.h"

namespace soslam {

// Signed distance (m) of a point from a landmark's surface, positive outside.
//
// Cuboid: max(|x_i| - a_i), the largest excess over a face. Exact inside and in front of a face; an
// underestimate beyond edges and corners. It never changes by more than the point moves.
//
// Others: the distance to first order, (F - 1) / |dF / dx|, with the body F = || (x / a, y / b,
// z / c) ||_q <= 1 of BodySurface. Exact on the surface, to second order near it, and for spheres
// anywhere. It is continuous but at the centre, where F has no gradient: there it is the negative
// of the shortest half axis, with derivatives of zero. Far inside, where the nearest faces of a
// body with long and short axes take turns, it changes up to about q times as fast as the point
// moves.
//
// All in one frame; `jacobian` and `normal`, the outward unit normal of the level surface through
// the point, may be null.
double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal = nullptr);

}  // namespace soslam
