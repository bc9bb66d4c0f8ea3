// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/parameters.h"

#include <algorithm>
#include <cmath>

namespace soslam {

PoseBlock ToParameterBlock(const Rigid3d& pose) {
  const auto& q = pose.rotation;
  const auto& t = pose.translation;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

LandmarkBlock ToParameterBlock(const Landmark& landmark) {
  const PoseBlock pose = ToParameterBlock(landmark.frame_from_object);
  LandmarkBlock block;
  std::copy(pose.begin(), pose.end(), block.begin());
  for (int i = 0; i < 3; ++i) block[kPoseSize + i] = std::log(landmark.half_axes(i));
  return block;
}

Rigid3d UnpackPose(const double* block) {
  return {Eigen::Quaterniond(block).normalized(), Eigen::Vector3d(block + 4)};
}

Landmark UnpackLandmark(const double* block, const ShapeExponents& shape_exponents) {
  return {UnpackPose(block), Eigen::Vector3d(block + kPoseSize).array().exp(), shape_exponents};
}

Eigen::Matrix<double, 3, 4> RotationVectorJacobian(const double* quaternion_xyzw) {
  // dw = 2 vec(dq q*), with q* the conjugate of the unit quaternion q.
  const Eigen::Vector3d vec(quaternion_xyzw);
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = 2.0 * (quaternion_xyzw[3] * Eigen::Matrix3d::Identity() + Skew(vec));
  matrix.rightCols<1>() = -2.0 * vec;
  return matrix;
}

RelativeObservation::RelativeObservation(double const* const* blocks,
                                         const ShapeExponents& shape_exponents) {
  const Rigid3d world_from_camera = UnpackPose(blocks[0]);
  const Landmark landmark_in_world = UnpackLandmark(blocks[1]);
  const Rigid3d& world_from_object = landmark_in_world.frame_from_object;
  camera_from_world_ = world_from_camera.rotation.toRotationMatrix().transpose();
  offset_in_world_ = world_from_object.translation - world_from_camera.translation;
  landmark_in_camera_.frame_from_object = {
      world_from_camera.rotation.conjugate() * world_from_object.rotation,
      camera_from_world_ * offset_in_world_};
  landmark_in_camera_.half_axes = landmark_in_world.half_axes;
  landmark_in_camera_.shape_exponents = shape_exponents;
}

}  // namespace soslam
