// SPDX-License-Identifier: BSD-3-Clause
#include "planes/camera_attitude.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace soslam {
namespace {

double AngleBetween(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return std::atan2(one.cross(other).norm(), one.dot(other));
}

}  // namespace

Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Vector3d up = eigen.eigenvectors().col(0);
  return up.dot(above) < 0.0 ? -up : up;
}

std::vector<double> ShareOfCameras(const std::vector<Rigid3d>& world_from_camera,
                                   double correlation_rad) {
  std::vector<double> shares(world_from_camera.size(), 1.0);
  if (!(correlation_rad > 0.0)) return shares;
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Vector3d forward = world_from_camera[i].rotation * Eigen::Vector3d::UnitZ();
    double cameras = 0.0;
    for (const Rigid3d& other : world_from_camera) {
      const double angle = AngleBetween(forward, other.rotation * Eigen::Vector3d::UnitZ());
      cameras += std::exp(-0.5 * std::pow(angle / correlation_rad, 2));
    }
    shares[i] = 1.0 / cameras;
  }
  return shares;
}

CameraAttitude AttitudeOf(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                          double pitch_sigma, double correlation_rad, CameraHolding holding) {
  const HeldAxes held = AxesOf(holding);
  CameraAttitude attitude;
  Eigen::Vector3d above = Eigen::Vector3d::Zero();
  const std::vector<double> shares = ShareOfCameras(world_from_camera, correlation_rad);
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
