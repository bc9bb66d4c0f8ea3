// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/multi_view.h"

namespace soslam {

// Small motion of a plane and all bodies on it: rotations (rad) about its horizontal axes, the x
// and y axes of UprightRotation(normal, 0), through a point, then a translation along the new
// normal (m).
using PlaneMotion = Eigen::Vector3d;
Plane Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion);
Landmark Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion,
               const Landmark& landmark);

// Quadratic approximation, in the plane's motion, of the cost of an object's boxes, minimised over
// the body on the plane.
struct PlaneEvidence {
  double cost = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// The boxes of an object and the body on a plane that fits them best.
struct StandingBody {
  MultiViewObservation observation;  // plane_in_world: the plane that it stands on
  Landmark landmark;
};

// The best body on its plane near the given one. None when the fit fails.
std::optional<StandingBody> FitOnPlane(StandingBody body);

// Evidence at a body returned by FitOnPlane, with its six degrees of freedom marginalised.
PlaneEvidence EvidenceOf(const StandingBody& body, const Eigen::Vector3d& pivot);

// The best body on a plane with this normal and free height, over all yaws in steps of `step`
// (rad). None when the views do not determine its height.
std::optional<StandingBody> FitBodyAtFreeHeight(MultiViewObservation observation,
                                                const Eigen::Vector3d& normal_in_world,
                                                double step);

}  // namespace soslam
