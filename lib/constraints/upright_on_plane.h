// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/parameters.h"

namespace soslam {

// An object of any shape exponents stands upright on its support plane: eq. (5)-(8), with the
// height of the centre over the plane, which must equal the half axis c, in place of pi^T Q* pi. In
// metres, so that a flat object is constrained as strongly as a high one.
//
// Residuals: 3 (cosines of the x and y axis with the normal, height minus c), each divided by its
// standard deviation. Blocks: landmark in the world; unit normal and offset of the plane in the
// world. `side` is 1, or -1 if the plane's normal is opposite to the block's, as for a ceiling that
// shares the floor's normal.
class UprightOnPlaneResidual final
    : public ceres::SizedCostFunction<3, kLandmarkSize, kNormalSize, kOffsetSize> {
 public:
  UprightOnPlaneResidual(double angle_sigma_rad, double height_sigma_m, double side = 1.0)
      : angle_weight_(1.0 / angle_sigma_rad), height_weight_(1.0 / height_sigma_m), side_(side) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  double angle_weight_;
  double height_weight_;
  double side_;
};

}  // namespace soslam
