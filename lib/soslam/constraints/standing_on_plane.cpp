// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/standing_on_plane.h"

#include <ceres/normal_prior.h>

#include <Eigen/Eigenvalues>

#include "soslam/geometry/support_function.h"

namespace soslam {

StandingOnPlane::StandingOnPlane(const Landmark& landmark, const Plane& plane,
                                 const StandingSigmas& sigmas, bool may_lean) {
  const Eigen::Matrix3d frame_from_object = landmark.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d normal_in_object = frame_from_object.transpose() * plane.normal;
  const double c = landmark.half_axes.z();
  // The body is symmetric: it reaches as far down as up.
  const SupportValue support =
      may_lean ? SupportFunction(landmark.half_axes, landmark.shape_exponents, normal_in_object)
               : SupportValue{c, Eigen::Vector3d::Zero(), {0.0, 0.0, c}};
  const Eigen::Vector3d support_point = frame_from_object * support.point;
  residuals << normal_in_object.head<2>(), plane.SignedDistance(landmark.Centre()) - support.extent;
  d_landmark.setZero();
  d_landmark.topLeftCorner<2, 3>() =
      (frame_from_object.transpose() * Skew(plane.normal)).topRows<2>();
  d_landmark.row(2) << -support_point.cross(plane.normal).transpose(), plane.normal.transpose(),
      -support.d_log_half_axes.transpose();
  d_normal << frame_from_object.leftCols<2>().transpose(),
      (landmark.Centre() - support_point).transpose();
  d_offset = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d weights(1.0 / sigmas.angle_rad, 1.0 / sigmas.angle_rad,
                                1.0 / sigmas.height_m);
  residuals = weights.cwiseProduct(residuals);
  d_landmark = weights.asDiagonal() * d_landmark;
  d_normal = weights.asDiagonal() * d_normal;
  d_offset = weights.cwiseProduct(d_offset);
}

bool StandingOnPlaneResidual::Evaluate(double const* const* blocks, double* residuals,
                                       double** jacobians) const {
  const Landmark landmark = UnpackLandmark(blocks[0], shape_exponents_);
  if (!landmark.half_axes.allFinite())
    return false;  // the step was too large: the solver shortens it
  const Plane plane{side_ * Eigen::Map<const Eigen::Vector3d>(blocks[1]), *blocks[2]};
  const StandingOnPlane standing(landmark, plane, sigmas_, may_lean_);
  Eigen::Map<Eigen::Vector3d>(residuals, 3) = standing.residuals;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    WriteLandmarkJacobian<3>(blocks[0], standing.d_landmark, jacobians[0]);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 3, kNormalSize, Eigen::RowMajor>> d_normal(jacobians[1]);
    d_normal = side_ * standing.d_normal;
  }
  if (jacobians[2] != nullptr) Eigen::Map<Eigen::Vector3d>(jacobians[2], 3) = standing.d_offset;
  return true;
}

std::unique_ptr<ceres::CostFunction> PlaneNormalPrior(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  return std::make_unique<ceres::NormalPrior>(
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose(),
      Eigen::Vector3d::Zero());
}

bool PlaneHeightResidual::Evaluate(double const* const* blocks, double* residuals,
                                   double** jacobians) const {
  const Eigen::Vector3d d_normal = side_ / prior_.sigma_m * prior_.point_in_world;
  residuals[0] =
      d_normal.dot(Eigen::Map<const Eigen::Vector3d>(blocks[0])) + blocks[1][0] / prior_.sigma_m;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) Eigen::Map<Eigen::Vector3d>{jacobians[0]} = d_normal;
  if (jacobians[1] != nullptr) jacobians[1][0] = 1.0 / prior_.sigma_m;
  return true;
}

}  // namespace soslam
