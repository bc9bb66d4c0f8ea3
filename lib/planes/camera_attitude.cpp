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

CameraAttitude AttitudeOf(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                          double pitch_sigma, double correlation_rad) {
  CameraAttitude attitude;
  Eigen::Vector3d above = Eigen::Vector3d::Zero();
  for (const Rigid3d& pose : world_from_camera) {
    const Eigen::Matrix3d axes = pose.rotation.toRotationMatrix();
    double cameras = 0.0;
    for (const Rigid3d& other : world_from_camera) {
      const double angle = AngleBetween(axes.col(2), other.rotation * Eigen::Vector3d::UnitZ());
      cameras += correlation_rad > 0.0 ? std::exp(-0.5 * std::pow(angle / correlation_rad, 2))
                                       : (&pose == &other ? 1.0 : 0.0);
    }
    attitude.information += (axes.col(0) * axes.col(0).transpose() / (roll_sigma * roll_sigma) +
                             axes.col(2) * axes.col(2).transpose() / (pitch_sigma * pitch_sigma)) /
                            cameras;
    above -= axes.col(1);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(attitude.information);
  attitude.up_in_world = eigen.eigenvectors().col(0);
  if (attitude.up_in_world.dot(above) < 0.0) attitude.up_in_world *= -1.0;
  return attitude;
}

}  // namespace soslam
