// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "soslam/geometry/landmark.h"

namespace soslam {

// Signed distance (m) of a point from a landmark's surface, positive outside.
//
// Flat faces (all of the cuboid's, the caps of bodies with a vertical exponent of 1): |x_i| - a_i.
// Curved sides: the distance to first order, (F - 1) / |dF / dx|, with the body F <= 1 of
// BodySurface; exact on the surface, to second order near it, and for spheres anywhere. A body with
// both has the larger of the two. Rectangular sections without flat caps are rounded, by 2 % of the
// size at their corners. Exact inside and in front of a face; an underestimate beyond
// edges and corners.
//
// It is continuous but at the centre (the axis, for a body with caps), where F has no gradient:
// there it is the negative of the shortest half axis, with derivatives of zero. A flat face's
// distance never changes by more than the point moves; far inside a curved body with long and short
// axes, where the nearest faces take turns, it changes up to about q times as fast, q the dual
// exponent.
//
// All in one frame; `jacobian` and `normal`, the outward unit normal of the level surface through
// the point, may be null.
double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal = nullptr);

}  // namespace soslam
