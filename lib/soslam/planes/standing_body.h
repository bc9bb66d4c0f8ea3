// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/base/quadratic_model.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Small motion of a plane and all bodies on it: rotations (rad) about its horizontal axes, the x
// and y axes of UprightRotation(normal, 0), through a point, then a translation along the new
// normal (m).
using PlaneMotion = Eigen::Vector3d;
Plane ApplyMotion(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion);
Landmark ApplyMotion(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion,
                     const Landmark& landmark);

// The cost of an object's boxes to second order in the plane's motion, minimised over the body on
// the plane.
using PlaneEvidence = QuadraticModel<3>;

// The boxes of an object and the body on a plane that fits them best.
struct StandingBody {
  ObjectEvidence evidence;  // plane: the one that it stands on
  Landmark landmark;
};

// The best body on its plane near the given one. None when the fit fails.
std::optional<StandingBody> FitOnPlane(StandingBody body);

// Evidence at a body that fits best on its plane, with its six degrees of freedom marginalised.
PlaneEvidence ComputePlaneEvidence(const StandingBody& body, const Eigen::Vector3d& pivot);

// The best body on a plane with this normal and free height, over all yaws in steps of `step`
// (rad). None when the views do not determine its height.
std::optional<StandingBody> FitBodyAtFreeHeight(ObjectEvidence observation,
                                                const Eigen::Vector3d& normal_in_world,
                                                double step);

// The cost of a height prior as a function of a plane's motion.
PlaneEvidence ComputePlaneEvidence(const HeightPrior& prior, const Plane& plane,
                                   const Eigen::Vector3d& pivot);

// Parallel planes, the bodies that stand on them, what points tell of them, and the prior on up.
struct StandingBodies {
  std::vector<StandingBody> bodies;
  std::vector<int> plane_of;  // for each body, an index into planes
  std::vector<Plane> planes;  // all with the same normal
  UpPrior up_prior;
  double height_sigma_fraction = 0.0;     // see PlanesOptions
  std::vector<HeightPrior> heights = {};  // of planes of points
  std::vector<int> plane_of_height = {};  // for each of them, an index into planes
};

// The up prior's cost as a function of a plane's motion.
PlaneEvidence ComputePlaneEvidence(const UpPrior& up_prior, const Plane& plane);

// Standard deviation of a body's height over its plane (m).
double HeightSigma(const StandingBody& body, double height_sigma_fraction);

// Mean of the bodies' lowest points; at least one body.
Eigen::Vector3d MeanBasePoint(const std::vector<StandingBody>& bodies);

// Optimises the planes' common normal, their heights and all bodies with Levenberg-Marquardt. None
// when a body's fit on its plane fails.
struct RefinedPlanes {
  double cost = 0.0;
  Eigen::Vector3d pivot;       // centre of the covariance's motions
  Eigen::MatrixXd covariance;  // two rotations (rad), then the translation of each plane (m)
};
std::optional<RefinedPlanes> RefinePlanes(StandingBodies* standing, int threads);

}  // namespace soslam
