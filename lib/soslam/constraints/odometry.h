// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "soslam/constraints/odometry_noise.h"
#include "soslam/constraints/parameters.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// Odometry constraint (F_O of eq. (1)): the relative pose of two consecutive cameras equals the
// measured one. With E = measured^-1 * (world_from_first^-1 * world_from_second): the rotation
// vector of E (rad) and the difference of the translations (m, frame of the first camera), each
// divided by its sigma.
//
// Residuals: 6 (rotation, translation). Blocks: world_from_first, world_from_second. Smooth while
// the rotations differ by less than half a turn.
class OdometryResidual final : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  static constexpr int kNumResiduals = 6;

  OdometryResidual(const Rigid3d& first_from_second, const OdometryNoise& noise);

  Eigen::Matrix<double, kNumResiduals, 1> Values(const Rigid3d& world_from_first,
                                                 const Rigid3d& world_from_second) const;

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Rigid3d first_from_second_;
  double rotation_weight_;
  double translation_weight_;
};

}  // namespace soslam
