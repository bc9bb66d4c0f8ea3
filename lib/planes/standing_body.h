// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/multi_view.h"

namespace soslam {

// A small motion of a plane, together with all that stands on it: turns (rad) about its horizontal
// axes UprightRotation(normal, 0) x and y through a point, then a rise along the new normal (m).
using PlaneMotion = Eigen::Vector3d;
Plane Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion);
Landmark Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion,
               const Landmark& landmark);

// How the cost of an object's boxes changes with the plane that it stands on, when the body is
// always the best one for the plane: to second order in the plane's motion.
struct PlaneEvidence {
  double cost = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// An object and the body that explains its boxes best on a plane.
struct StandingBody {
  MultiViewObservation observation;  // plane_in_world: the plane that it stands on
  Landmark landmark;
};

// The body that is best on a plane, near the given one. None when it is lost.
std::optional<StandingBody> Settled(StandingBody body);

// At a settled body. The body's six degrees of freedom are free.
PlaneEvidence EvidenceOf(const StandingBody& body, const Eigen::Vector3d& pivot);

// The best body whose plane has this normal and any height, over all yaws in steps (rad). None when
// the views do not determine its height.
std::optional<StandingBody> BodyOfFreeHeight(MultiViewObservation observation,
                                             const Eigen::Vector3d& normal_in_world, double step);

}  // namespace soslam
