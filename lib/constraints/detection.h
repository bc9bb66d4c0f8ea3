// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <array>

#include "constraints/parameters.h"
#include "geometry/box.h"
#include "geometry/camera.h"

namespace soslam {

// Detection constraint, eq. (2)-(4): the planes pi_i back-projected from the four edges of a box
// are tangent to the landmark. Residual i is pi_i^T Q* pi_i / sqrt(variance), the QuadricTangency.
//
// Residuals: 4 (left, top, right, bottom). Blocks: world_from_camera, landmark in the world.
// Defined everywhere; it does not distinguish an object in front of the camera from its reflection
// behind it.
class DetectionResidual final : public ceres::SizedCostFunction<4, kPoseSize, kLandmarkSize> {
 public:
  // `variance` is the paper's Sigma_det, in m^4.
  DetectionResidual(const Camera& camera, const Box& box, double variance);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  std::array<Plane, 4> planes_in_camera_;
  double weight_;
};

}  // namespace soslam
