// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <string>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/landmark.h"

namespace soslam {

// Residuals of one image for one landmark. Blocks: world_from_camera, landmark in the world. Bodies
// of any shape have no loss on top of these: their cost should be bounded.
struct ImageResiduals {
  std::string name;      // in SolverSummary::residuals, with `count`; no other evidence has it
  std::string why_none;  // in SolverSummary::gated, where there are no functions
  std::vector<std::unique_ptr<ceres::CostFunction>> functions = {};
  int count = 0;               // of what they compare: pairs of pixels, images, points
  double constant_cost = 0.0;  // on top of theirs
};

// The evidence of an image about the landmark of one detection, in its camera. The initial
// landmark has the least sum of the costs below, the map that of the residuals.
class ImageEvidence {
 public:
  virtual ~ImageEvidence() = default;

  // The residuals. What they compare, as the edges that are visible, is chosen at `start`. How
  // reliable the image is may be measured at another landmark, `weighed_at`; null: at `start`.
  // `weight` is below 1 where other detections see the object from the same side
  // (view_correlation_deg): a factor of the cost of what errs as their boxes do. What errs
  // independently need not have it.
  virtual ImageResiduals ResidualsAt(const Landmark& start, const Landmark* weighed_at,
                                     double weight) const = 0;

  // The cost near a start, with derivatives; null: it has no part in fits.
  virtual std::unique_ptr<const LandmarkCost> CostNear(const Landmark& /*start*/) const {
    return nullptr;
  }

  // A cost, none below zero, by which fitted landmarks are compared, beside that of CostNear.
  virtual double ComparedCost(const Landmark& /*landmark*/) const { return 0.0; }
};

}  // namespace soslam
