// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "initialisation/yaw_sweep.h"

namespace soslam {

inline Eigen::VectorXd Residuals(const LandmarkTerm& term, const Landmark& landmark) {
  Eigen::VectorXd residuals(term.NumResiduals());
  term.Evaluate(landmark, residuals, nullptr);
  return residuals;
}

inline double Cost(const LandmarkTerm& term, const Landmark& landmark) {
  return 0.5 * Residuals(term, landmark).squaredNorm();
}

inline double Cost(const LandmarkTerms& terms, const Landmark& landmark) {
  double cost = 0.0;
  for (const auto& term : terms) cost += Cost(*term, landmark);
  return cost;
}

// The sum of the observation's terms, tangent points at the depths of the landmark itself.
inline double CostAtOwnDepths(const UprightObservation& observation, const Landmark& landmark) {
  return Cost(BoxTerms(observation, landmark), landmark);
}

}  // namespace soslam
