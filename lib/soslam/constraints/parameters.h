// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/manifold.h>
#include <ceres/product_manifold.h>
#include <ceres/sphere_manifold.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "soslam/geometry/landmark.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// Parameter blocks of the residuals. A pose is (qx, qy, qz, qw, tx, ty, tz); a landmark is its pose
// followed by the logarithms of its half axes, which thus stay positive without bounds. A plane is
// two blocks: its unit normal, which parallel planes share, and its offset. A detector's bias (px)
// at one side of its boxes is one block, and so is the logarithm of the factor of all focal
// lengths.
inline constexpr int kPoseSize = 7;
inline constexpr int kLandmarkSize = 10;
inline constexpr int kNormalSize = 3;
inline constexpr int kOffsetSize = 1;
inline constexpr int kBiasSize = 1;
inline constexpr int kLogFocalSize = 1;
using PoseBlock = std::array<double, kPoseSize>;
using LandmarkBlock = std::array<double, kLandmarkSize>;

PoseBlock ToParameterBlock(const Rigid3d& pose);
LandmarkBlock ToParameterBlock(const Landmark& landmark);
Rigid3d UnpackPose(const double* block);
Landmark UnpackLandmark(const double* block,
                        const ShapeExponents& shape_exponents = kEllipsoidExponent);

// Jacobians are derived for a rotation vector w applied from the left, R -> exp(w) R. Ceres expects
// derivatives by quaternion coefficients; this 3 x 4 matrix, dw / d(qx, qy, qz, qw), converts one
// to the other.
Eigen::Matrix<double, 3, 4> RotationVectorJacobian(const double* quaternion_xyzw);

// kRows may be Eigen::Dynamic below.
//
// Writes d residual / d pose block (row-major, rows x 7) from the derivatives by rotation vector
// and translation.
template <int kRows>
void WritePoseJacobian(const double* pose_block,
                       const Eigen::Matrix<double, kRows, 3>& d_rotation_vector,
                       const Eigen::Matrix<double, kRows, 3>& d_translation, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, kRows, kPoseSize, Eigen::RowMajor>> map(
      jacobian, d_translation.rows(), kPoseSize);
  map.template leftCols<4>() = d_rotation_vector * RotationVectorJacobian(pose_block);
  map.template rightCols<3>() = d_translation;
}

// Writes d residual / d landmark block (row-major, rows x 10) from the derivatives by the
// landmark's nine degrees of freedom, in the order of kLandmarkDof.
template <int kRows>
void WriteLandmarkJacobian(const double* landmark_block,
                           const Eigen::Matrix<double, kRows, kLandmarkDof>& d_landmark,
                           double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, kRows, kLandmarkSize, Eigen::RowMajor>> map(
      jacobian, d_landmark.rows(), kLandmarkSize);
  map.template leftCols<4>() =
      d_landmark.template leftCols<3>() * RotationVectorJacobian(landmark_block);
  map.template rightCols<6>() = d_landmark.template rightCols<6>();
}

// An observation depends on camera_from_object and the half axes only. This class computes that
// relative pose and chains derivatives by its nine degrees of freedom (order of kLandmarkDof) to
// the blocks world_from_camera and landmark in the world. Invariance to a rigid motion of the world
// follows by construction.
class RelativeObservation {
 public:
  explicit RelativeObservation(double const* const* blocks,
                               const ShapeExponents& shape_exponents = kEllipsoidExponent);

  const Landmark& landmark_in_camera() const { return landmark_in_camera_; }
  const Eigen::Matrix3d& camera_from_world() const { return camera_from_world_; }  // rotation

  template <int kRows>
  void WriteJacobians(const Eigen::Matrix<double, kRows, kLandmarkDof>& d_landmark,
                      double const* const* blocks, double** jacobians) const {
    if (jacobians == nullptr) return;
    using Block = Eigen::Matrix<double, kRows, 3>;
    // A rotation w of a world_from_x rotation is a rotation R^T w in the camera frame, R =
    // world_from_camera.
    const Block d_rotation = d_landmark.template leftCols<3>() * camera_from_world_;
    const Block d_centre = d_landmark.template middleCols<3>(3) * camera_from_world_;
    if (jacobians[0] != nullptr) {
      WritePoseJacobian<kRows>(blocks[0], -d_rotation + d_centre * Skew(offset_in_world_),
                               -d_centre, jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      Eigen::Matrix<double, kRows, kLandmarkDof> in_world(d_landmark.rows(), kLandmarkDof);
      in_world << d_rotation, d_centre, d_landmark.template rightCols<3>();
      WriteLandmarkJacobian<kRows>(blocks[1], in_world, jacobians[1]);
    }
  }

 private:
  Eigen::Matrix3d camera_from_world_;  // rotation only
  Eigen::Vector3d offset_in_world_;    // object centre minus camera centre
  Landmark landmark_in_camera_;
};

// The manifold of a pose block (see parameters.h): 6 tangent dimensions.
inline ceres::Manifold* NewPoseManifold() {
  return new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
}

// The manifold of a landmark block: 9 tangent dimensions. Its rotation part is half a rotation
// vector applied from the left (Ceres' convention).
inline ceres::Manifold* NewLandmarkManifold() {
  return new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<6>>;
}

// The manifold of a plane's normal: 2 tangent dimensions.
inline ceres::Manifold* NewNormalManifold() { return new ceres::SphereManifold<3>; }

}  // namespace soslam
