// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <array>

#include "constraints/parameters.h"
#include "geometry/box.h"
#include "geometry/camera.h"

namespace soslam {

// Detection constraint, eq. (2)-(4): the planes pi_i back-projected from the four edges of a box
// are tangent to the landmark. Residual i is pi_i^T Q* pi_i / sqrt(variance), pi_i with unit
// normal, so that the unweighted residual is in m^2: the squared support value of the landmark in
// the direction of the plane's normal minus the squared distance of the plane from its centre.
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
  std::array<Eigen::Vector3d, 4> normals_in_camera_;  // the planes pass through the camera centre
  double weight_;
};

}  // namespace soslam
