// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/parameters.h"
#include "geometry/plane.h"

namespace soslam {

// Support constraint, eq. (5)-(8): the landmark's x and y axes are orthogonal to the support normal
// (cosines, no unit), and the support plane is tangent to it (QuadricTangency, m^2). Each residual
// is divided by the square root of its variance.
//
// Residuals: 3 (x axis, y axis, tangency). Block: landmark in the world. Defined everywhere;
// it distinguishes neither up from down nor above the plane from below: the initial guess decides.
class SupportResidual final : public ceres::SizedCostFunction<3, kLandmarkSize> {
 public:
  // `angle_variance` and `tangency_variance` are the paper's Sigma_theta and Sigma_pi (m^4).
  SupportResidual(const Plane& plane_in_world, double angle_variance, double tangency_variance);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Plane plane_in_world_;
  double angle_weight_;
  double tangency_weight_;
};

}  // namespace soslam
