// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/odometry.h"

#include <algorithm>
#include <cmath>

namespace soslam {
namespace {

// d log(exp(v) exp(w)) / dw at w = 0: the inverse right Jacobian of SO(3).
Eigen::Matrix3d InverseRightJacobian(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d skew = Skew(v);
  // The limit of the second coefficient at 0 is 1/12.
  const double coefficient =
      angle > 1e-4 ? 1.0 / (angle * angle) - 0.5 / (angle * std::tan(0.5 * angle)) : 1.0 / 12.0;
  return Eigen::Matrix3d::Identity() + 0.5 * skew + coefficient * skew * skew;
}

}  // namespace

double OdometryNoise::RotationSigma(const Eigen::Quaterniond& rotation) const {
  constexpr double kLeastShare = 0.025;  // of a camera that does not turn
  if (!(rotation_fraction > 0.0)) return rotation_rad;
  return std::clamp(rotation_fraction * LogRotation(rotation).norm(), kLeastShare * rotation_rad,
                    rotation_rad);
}

OdometryResidual::OdometryResidual(const Rigid3d& first_from_second, const OdometryNoise& noise)
    : first_from_second_(first_from_second),
      rotation_weight_(1.0 / noise.RotationSigma(first_from_second.rotation)),
      translation_weight_(1.0 / noise.translation_m) {}

Eigen::Matrix<double, 6, 1> OdometryResidual::Values(const Rigid3d& world_from_first,
                                                     const Rigid3d& world_from_second) const {
  const PoseBlock first = ToParameterBlock(world_from_first);
  const PoseBlock second = ToParameterBlock(world_from_second);
  const double* blocks[] = {first.data(), second.data()};
  Eigen::Matrix<double, kNumResiduals, 1> values;
  Evaluate(blocks, values.data(), nullptr);
  return values;
}

bool OdometryResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const Rigid3d world_from_first = UnpackPose(blocks[0]);
  const Rigid3d world_from_second = UnpackPose(blocks[1]);
  const Rigid3d estimate = world_from_first.Inverse() * world_from_second;
  const Eigen::Vector3d rotation_error =
      LogRotation(first_from_second_.rotation.conjugate() * estimate.rotation);

  Eigen::Map<Eigen::Vector3d>(residuals).noalias() = rotation_weight_ * rotation_error;
  Eigen::Map<Eigen::Vector3d>(residuals + 3).noalias() =
      translation_weight_ * (estimate.translation - first_from_second_.translation);
  if (jacobians == nullptr) return true;

  using Block = Eigen::Matrix<double, 6, 3>;
  const Eigen::Matrix3d first_from_world = world_from_first.rotation.toRotationMatrix().transpose();
  const Eigen::Matrix3d d_second = InverseRightJacobian(rotation_error) *
                                   world_from_second.rotation.toRotationMatrix().transpose();
  Block d_rotation = Block::Zero();
  Block d_translation = Block::Zero();
  if (jacobians[0] != nullptr) {
    d_rotation.topRows<3>() = -rotation_weight_ * d_second;
    d_rotation.bottomRows<3>() = translation_weight_ * first_from_world *
                                 Skew(world_from_second.translation - world_from_first.translation);
    d_translation.bottomRows<3>() = -translation_weight_ * first_from_world;
    WritePoseJacobian<6>(blocks[0], d_rotation, d_translation, jacobians[0]);
  }
  if (jacobians[1] != nullptr) {
    d_rotation.topRows<3>() = rotation_weight_ * d_second;
    d_rotation.bottomRows<3>().setZero();
    d_translation.bottomRows<3>() = translation_weight_ * first_from_world;
    WritePoseJacobian<6>(blocks[1], d_rotation, d_translation, jacobians[1]);
  }
  return true;
}

}  // namespace soslam
