// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/support.h"

#include <cmath>

namespace soslam {

SupportResidual::SupportResidual(const Plane& plane_in_world, double angle_variance,
                                 double tangency_variance)
    : plane_in_world_(plane_in_world),
      angle_weight_(1.0 / std::sqrt(angle_variance)),
      tangency_weight_(1.0 / std::sqrt(tangency_variance)) {}

bool SupportResidual::Evaluate(double const* const* blocks, double* residuals,
                               double** jacobians) const {
  const Landmark landmark = UnpackLandmark(blocks[0]);
  const Eigen::Vector3d squared_axes = landmark.half_axes.cwiseAbs2();
  if (!squared_axes.allFinite()) return false;  // the step was too large: the solver shortens it
  const Eigen::Vector3d& normal = plane_in_world_.normal;
  const Eigen::Matrix3d object_from_world =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d normal_in_object = object_from_world * normal;
  const Eigen::Vector3d weighted = squared_axes.cwiseProduct(normal_in_object);
  const double distance = plane_in_world_.SignedDistance(landmark.Centre());

  residuals[0] = angle_weight_ * normal_in_object.x();
  residuals[1] = angle_weight_ * normal_in_object.y();
  residuals[2] = tangency_weight_ * (weighted.dot(normal_in_object) - distance * distance);
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;

  const Eigen::Matrix3d d_rotation = object_from_world * Skew(normal);
  Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
  d_landmark.setZero();
  d_landmark.topLeftCorner<2, 3>() = angle_weight_ * d_rotation.topRows<2>();
  d_landmark.row(2) << 2.0 * weighted.transpose() * d_rotation,
      -2.0 * distance * normal.transpose(),
      2.0 * weighted.cwiseProduct(normal_in_object).transpose();
  d_landmark.row(2) *= tangency_weight_;
  WriteLandmarkJacobian<3>(blocks[0], d_landmark, jacobians[0]);
  return true;
}

}  // namespace soslam
