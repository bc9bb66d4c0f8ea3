// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "initialisation/upright_observation.h"

namespace soslam {

inline Eigen::VectorXd Residuals(const LandmarkTerm& term, const Landmark& landmark) {
  Eigen::VectorXd residuals(term.NumResiduals());
  term.Evaluate(landmark, residuals, nullptr);
  return residuals;
}

// The sum of the observation's terms, tangent points at the depths of the landmark itself.
inline double CostAtOwnDepths(const UprightObservation& observation, const Landmark& landmark) {
  return TotalCost(ObservationTerms(observation, landmark), landmark);
}

}  // namespace soslam
