// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planes/standing_body.h"
#include "planes/up_prior.h"

namespace soslam {

// Parallel planes, the bodies that stand on them, and the prior on up.
struct StandingBodies {
  std::vector<StandingBody> bodies;
  std::vector<int> plane_of;  // for each body, an index into planes
  std::vector<Plane> planes;  // all with the same normal
  UpPrior attitude;
  double height_sigma_fraction = 0.0;  // see PlanesOptions
};

// The attitude's cost as a function of a plane's motion.
PlaneEvidence EvidenceOf(const UpPrior& attitude, const Plane& plane);

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
std::optional<RefinedPlanes> Refine(StandingBodies* standing, int threads);

}  // namespace soslam
