// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/standing.h"

namespace soslam {

StandingResidual::StandingResidual(const Plane& plane_in_world, double angle_sigma_rad,
                                   double height_sigma_m)
    : plane_in_world_(plane_in_world),
      angle_weight_(1.0 / angle_sigma_rad),
      height_weight_(1.0 / height_sigma_m) {}

bool StandingResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const Landmark landmark = UnpackLandmark(blocks[0]);
  if (!landmark.half_axes.allFinite()) return false;  // a step too far: the solver shortens it
  const Eigen::Vector3d& normal = plane_in_world_.normal;
  const Eigen::Matrix3d object_from_world =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d normal_in_object = object_from_world * normal;
  residuals[0] = angle_weight_ * normal_in_object.x();
  residuals[1] = angle_weight_ * normal_in_object.y();
  residuals[2] =
      height_weight_ * (plane_in_world_.SignedDistance(landmark.Centre()) - landmark.half_axes.z());
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;

  Eigen::Matrix<double, 3, kLandmarkDof> by_landmark;
  by_landmark.setZero();
  by_landmark.topLeftCorner<2, 3>() =
      angle_weight_ * (object_from_world * Skew(normal)).topRows<2>();
  by_landmark.block<1, 3>(2, 3) = height_weight_ * normal.transpose();
  by_landmark(2, 8) = -height_weight_ * landmark.half_axes.z();
  WriteLandmarkJacobian<3>(blocks[0], by_landmark, jacobians[0]);
  return true;
}

}  // namespace soslam
