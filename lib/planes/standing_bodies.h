// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planes/camera_attitude.h"
#include "planes/standing_body.h"

namespace soslam {

// Parallel planes, the bodies that stand on them, and what is known of up.
struct StandingBodies {
  std::vector<StandingBody> bodies;
  std::vector<int> plane_of;  // for each body, an index into planes
  std::vector<Plane> planes;  // with one normal
  CameraAttitude attitude;
  double height_sigma_fraction = 0.0;  // see PlanesOptions
};

// The attitude's cost as that of a plane's motion.
PlaneEvidence EvidenceOf(const CameraAttitude& attitude, const Plane& plane);

// How much a body may stand above or below its plane (m).
double HeightSigma(const StandingBody& body, double height_sigma_fraction);

// The point in the middle of the bodies' feet; of at least one.
Eigen::Vector3d MiddleOfFeet(const std::vector<StandingBody>& bodies);

// Levenberg-Marquardt over the planes' normal and heights and all bodies. None when a body does not
// settle on its plane.
struct RefinedPlanes {
  double cost = 0.0;
  Eigen::Vector3d pivot;       // of the covariance's motions
  Eigen::MatrixXd covariance;  // two turns, then the rise of each plane
};
std::optional<RefinedPlanes> Refine(StandingBodies* standing, int threads);

}  // namespace soslam
