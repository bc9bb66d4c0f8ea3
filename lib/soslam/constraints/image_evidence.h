// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/landmark.h"

namespace soslam {

// Residuals of one image for one landmark. Blocks: world_from_camera, landmark in the world.
struct ImageResiduals {
  std::vector<std::unique_ptr<ceres::CostFunction>> functions;
  int count = 0;               // of what they compare, as the pairs of a texture
  double constant_cost = 0.0;  // on top of theirs
};

// What an image says about the landmark of one detection. Landmarks are in its camera.
class ImageEvidence {
 public:
  virtual ~ImageEvidence() = default;

  // Name of its residuals in SolverSummary::residuals.
  virtual const char* Kind() const = 0;
  // Name in SolverSummary::gated of an image without residuals.
  virtual const char* WhyNoResiduals() const = 0;

  // The residuals, multiplied by a weight. What is compared, as the edges that are visible, is
  // chosen at `start`. It may weigh less where it fits another landmark badly: `start` if null.
  virtual ImageResiduals ResidualsAt(const Landmark& start, const Landmark* weighed_at,
                                     double weight) const = 0;

  // The cost near a start, with derivatives; null if landmarks can only be compared.
  virtual std::unique_ptr<const LandmarkCost> CostNear(const Landmark& /*start*/) const {
    return nullptr;
  }
  virtual bool IsOnlyCompared() const = 0;
  // The cost by which landmarks are compared, none below zero.
  virtual double ComparedCost(const Landmark& /*landmark*/) const { return 0.0; }
};

}  // namespace soslam
