// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "constraints/parameters.h"
#include "geometry/box.h"
#include "geometry/camera.h"

namespace soslam {

// An edge of a detection's box, for a body of any shape exponent.
struct BoxEdge {
  // K^T l of the edge's line l, pointing out of the box: plane . x / x_z is the signed distance
  // (px) by which the projection of x (camera frame) lies outside the edge.
  Eigen::Vector3d plane;
  // True if the object may reach beyond the edge (the image border or a nearer object truncates
  // it).
  bool is_bound = false;
  double sigma_px = 1.0;
};

// Edges in the order left, top, right, bottom.
std::array<BoxEdge, 4> BoxEdges(const Camera& camera, const Box& box,
                                const std::array<bool, 4>& is_bound, double sigma_fraction);

// Signed distance (px / sigma) by which an object reaches outside a box edge: zero when the plane
// behind the edge is tangent to it. Equals h(n) + n . c + d of the plane in metres, divided by the
// depth of the tangent point (fixed: its change alters the residual by less than the residual's own
// size) and multiplied by the focal length. For a bound edge it is zero when positive. At p = 2 it
// has the same zeros as the paper's eq. (3), as pi^T Q* pi = h^2 - (n . c + d)^2. `bias_px` moves
// the edge outwards before the comparison.
double Tangency(const BoxEdge& edge, const Landmark& landmark_in_camera, double depth_m,
                double bias_px, LandmarkJacobian1* jacobian);

// Depth of the point where an object is tangent to a plane parallel to the one behind an edge.
double TangentDepth(const BoxEdge& edge, const Landmark& landmark_in_camera);

// Signed distance (px / sigma) by which an object's silhouette reaches outside a box edge. Tangency
// is its linearisation; this is exact, so that residual and Jacobian agree wherever the object is.
// The whole object must be in front of the camera.
double OutlineExcess(const BoxEdge& edge, const Landmark& landmark_in_camera,
                     LandmarkJacobian1* jacobian);

}  // namespace soslam
