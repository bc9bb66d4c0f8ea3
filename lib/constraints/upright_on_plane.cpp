// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/upright_on_plane.h"

namespace soslam {

bool UprightOnPlaneResidual::Evaluate(double const* const* blocks, double* residuals,
                                      double** jacobians) const {
  const Landmark landmark = UnpackLandmark(blocks[0]);
  if (!landmark.half_axes.allFinite())
    return false;  // the step was too large: the solver shortens it
  Plane plane = UnpackPlane(blocks[1], blocks[2]);
  plane.normal *= side_;
  const Eigen::Matrix3d object_from_world =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d normal_in_object = object_from_world * plane.normal;
  residuals[0] = angle_weight_ * normal_in_object.x();
  residuals[1] = angle_weight_ * normal_in_object.y();
  residuals[2] =
      height_weight_ * (plane.SignedDistance(landmark.Centre()) - landmark.half_axes.z());
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
    d_landmark.setZero();
    d_landmark.topLeftCorner<2, 3>() =
        angle_weight_ * (object_from_world * Skew(plane.normal)).topRows<2>();
    d_landmark.block<1, 3>(2, 3) = height_weight_ * plane.normal.transpose();
    d_landmark(2, 8) = -height_weight_ * landmark.half_axes.z();
    WriteLandmarkJacobian<3>(blocks[0], d_landmark, jacobians[0]);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 3, kNormalSize, Eigen::RowMajor>> d_normal(jacobians[1]);
    d_normal.topRows<2>() = side_ * angle_weight_ * object_from_world.topRows<2>();
    d_normal.row(2) = side_ * height_weight_ * landmark.Centre().transpose();
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Vector3d>(jacobians[2]) << 0.0, 0.0, height_weight_;
  }
  return true;
}

}  // namespace soslam
