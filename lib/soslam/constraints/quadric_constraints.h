// SPDX-License-Identifier: BSD-3-Clause
// The paper's constraints on ellipsoids but symmetry.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <array>

#include "soslam/constraints/parameters.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/plane.h"

namespace soslam {

// Detection constraint, eq. (2)-(4): the planes pi_i back-projected from the four edges of a box
// are tangent to the landmark. Residual i is pi_i^T Q* pi_i (m^2) / sqrt(variance).
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

// Support constraint, eq. (5)-(8): the landmark's x and y axes are orthogonal to the support normal
// (cosines, no unit), and the support plane is tangent to it (pi^T Q* pi, m^2). Each residual
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

// Scale ratio constraint, eq. (9)-(11): (a / c, b / c) equals the label's entry in the semantic
// table. Divided by the square root of the variance; no unit.
//
// Residuals: 2. Block: landmark (any frame).
class ScaleRatioResidual final : public ceres::SizedCostFunction<2, kLandmarkSize> {
 public:
  // `ratio` = (a / c, b / c) > 0; `variance` is the paper's Sigma_ssc.
  ScaleRatioResidual(const Eigen::Vector2d& ratio, double variance);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector2d ratio_;
  double weight_;
};

}  // namespace soslam
