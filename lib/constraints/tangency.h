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
  // K^T l of the edge's line l, pointing out of the box: plane . x / x_z is how far (px) the
  // projection of x (camera frame) lies outside the edge.
  Eigen::Vector3d plane;
  // The object may reach farther than the edge (the image border or a nearer object cuts it off).
  bool is_bound = false;
  double sigma_px = 1.0;
};

// Left, top, right, bottom.
std::array<BoxEdge, 4> BoxEdges(const Camera& camera, const Box& box,
                                const std::array<bool, 4>& is_bound, double sigma_fraction);

// How far (px / sigma) a body reaches outside a box edge: zero when the plane behind the edge is
// tangent to it. h(n) + n . c + d of the plane in metres, divided by the depth of the tangent point
// (taken as known: it changes the residual by less than its own size) and multiplied by the focal
// length. For a bound only what is missing to the edge counts. At p = 2 this is the paper's eq.
// (3), as pi^T Q* pi = h^2 - (n . c + d)^2. `bias_px` moves the edge outwards before it is
// compared.
double Tangency(const BoxEdge& edge, const Landmark& landmark_in_camera, double depth_m,
                double bias_px, LandmarkJacobian1* jacobian);

// The depth of the point where a body is tangent to the plane behind an edge.
double TangentDepth(const BoxEdge& edge, const Landmark& landmark_in_camera);

// How far (px / sigma) the outline of a body reaches outside a box edge: what Tangency is to first
// order, exactly, so that residual and Jacobian agree wherever the body is. For a body wholly in
// front of the camera.
double OutlineExcess(const BoxEdge& edge, const Landmark& landmark_in_camera,
                     LandmarkJacobian1* jacobian);

}  // namespace soslam
