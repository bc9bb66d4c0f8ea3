// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "geometry/batch.h"
#include "initialisation/landmark_cost.h"

namespace soslam {

// Residuals and their derivatives by the nine parameters of a landmark.
struct ResidualBatch {
  Batch residual;
  std::array<Batch, kLandmarkDof> by_landmark;

  static ResidualBatch Zero();
  // Half the sum of their squares, multiplied by a weight.
  void AddTo(double weight, LandmarkModel* sum) const;
};

}  // namespace soslam
