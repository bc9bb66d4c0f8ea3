// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/landmark.h"
#include "geometry/plane.h"

namespace soslam {

// pi^T Q* pi of a plane pi (unit normal) and the landmark's ellipsoid, both in one frame (m^2),
// eq. (3) and (7): the squared support value in the direction of the normal minus the squared
// distance of the plane from the centre. Zero when the plane is tangent.
struct QuadricTangency {
  double value;
  LandmarkJacobian1 d_landmark;
};
QuadricTangency EvaluateQuadricTangency(const Plane& plane, const Landmark& landmark);

}  // namespace soslam
