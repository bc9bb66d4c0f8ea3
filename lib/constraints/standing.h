// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/parameters.h"
#include "geometry/plane.h"

namespace soslam {

// A body of any shape stands upright on its support plane: eq. (5)-(8) with the height of the
// centre over the plane, which is the half axis c, in place of pi^T Q* pi. In metres, so that a
// flat body is held as firmly as a high one.
//
// Residuals: 3 (cosines of the x and y axis with the normal, height minus c), each divided by its
// standard deviation. Block: landmark in the world.
class StandingResidual final : public ceres::SizedCostFunction<3, kLandmarkSize> {
 public:
  StandingResidual(const Plane& plane_in_world, double angle_sigma_rad, double height_sigma_m);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Plane plane_in_world_;
  double angle_weight_;
  double height_weight_;
};

}  // namespace soslam
