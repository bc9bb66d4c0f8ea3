// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "geometry/batch.h"
#include "initialisation/landmark_cost.h"

namespace soslam {

// Batch of residuals and their derivatives by the nine parameters of a landmark.
struct ResidualBatch {
  Batch residual;
  std::array<Batch, kLandmarkDof> by_landmark;

  static ResidualBatch Zero();
  // Adds half the sum of the squared residuals, multiplied by a weight.
  void AddTo(double weight, LandmarkModel* sum) const;
};

}  // namespace soslam
