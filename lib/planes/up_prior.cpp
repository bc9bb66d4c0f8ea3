// SPDX-License-Identifier: BSD-3-Clause
#include "planes/up_prior.h"

#include <Eigen/Eigenvalues>

#include "geometry/direction_weights.h"

namespace soslam {

Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Vector3d up = eigen.eigenvectors().col(0);
  return up.dot(above) < 0.0 ? -up : up;
}

std::vector<double> CameraWeights(const std::vector<Rigid3d>& world_from_camera,
                                  double correlation_rad) {
  std::vector<Eigen::Vector3d> optical_axes;
  for (const Rigid3d& pose : world_from_camera) {
    optical_axes.emplace_back(pose.rotation * Eigen::Vector3d::UnitZ());
  }
  return DirectionWeights(optical_axes, correlation_rad);
}

UpPrior UpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                           double pitch_sigma, double correlation_rad, CameraHolding holding) {
  const HeldAxes held = AxesOf(holding);
  UpPrior attitude;
  Eigen::Vector3d above = Eigen::Vector3d::Zero();
  const std::vector<double> shares = CameraWeights(world_from_camera, correlation_rad);
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Matrix3d rotation = world_from_camera[i].rotation.toRotationMatrix();
    const Eigen::Vector3d level = rotation * held.level;
    const Eigen::Vector3d third = rotation * held.up.cross(held.level);
    attitude.information += shares[i] * (level * level.transpose() / (roll_sigma * roll_sigma) +
                                         third * third.transpose() / (pitch_sigma * pitch_sigma));
    above += rotation * held.up;
  }
  attitude.up_in_world = LowestCostUp(attitude.information, above);
  return attitude;
}

}  // namespace soslam
