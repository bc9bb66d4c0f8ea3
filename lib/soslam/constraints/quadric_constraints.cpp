// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/quadric_constraints.h"

#include <cmath>

namespace soslam {
namespace {

// pi^T Q* pi of a plane pi (unit normal) and the landmark's ellipsoid, both in one frame (m^2),
// eq. (3) and (7): the squared support value in the direction of the normal minus the squared
// distance of the plane from the centre. Zero when the plane is tangent.
struct QuadricTangency {
  double value;
  LandmarkJacobian1 d_landmark;
};

QuadricTangency EvaluateQuadricTangency(const Plane& plane, const Landmark& landmark) {
  const Eigen::Matrix3d object_from_frame =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d normal_in_object = object_from_frame * plane.normal;
  const Eigen::Vector3d weighted = landmark.half_axes.cwiseAbs2().cwiseProduct(normal_in_object);
  const double distance = plane.SignedDistance(landmark.Centre());
  QuadricTangency tangency;
  tangency.value = weighted.dot(normal_in_object) - distance * distance;
  tangency.d_landmark << 2.0 * weighted.transpose() * object_from_frame * Skew(plane.normal),
      -2.0 * distance * plane.normal.transpose(),
      2.0 * weighted.cwiseProduct(normal_in_object).transpose();
  return tangency;
}

}  // namespace

DetectionResidual::DetectionResidual(const Camera& camera, const Box& box, double variance)
    : weight_(1.0 / std::sqrt(variance)) {
  const auto lines = box.EdgeLines();
  for (size_t i = 0; i < lines.size(); ++i) {
    planes_in_camera_[i] = camera.BackProject(lines[i]);
  }
}

bool DetectionResidual::Evaluate(double const* const* blocks, double* residuals,
                                 double** jacobians) const {
  const RelativeObservation observation(blocks);
  const Landmark& landmark = observation.landmark_in_camera();
  // The step was too large: the solver shortens it.
  if (!landmark.half_axes.cwiseAbs2().allFinite()) return false;
  Eigen::Matrix<double, 4, kLandmarkDof> d_landmark;
  for (int i = 0; i < 4; ++i) {
    const QuadricTangency tangency = EvaluateQuadricTangency(planes_in_camera_[i], landmark);
    residuals[i] = weight_ * tangency.value;
    d_landmark.row(i) = tangency.d_landmark;
  }
  observation.WriteJacobians<4>(weight_ * d_landmark, blocks, jacobians);
  return true;
}

SupportResidual::SupportResidual(const Plane& plane_in_world, double angle_variance,
                                 double tangency_variance)
    : plane_in_world_(plane_in_world),
      angle_weight_(1.0 / std::sqrt(angle_variance)),
      tangency_weight_(1.0 / std::sqrt(tangency_variance)) {}

bool SupportResidual::Evaluate(double const* const* blocks, double* residuals,
                               double** jacobians) const {
  const Landmark landmark = UnpackLandmark(blocks[0]);
  // The step was too large: the solver shortens it.
  if (!landmark.half_axes.cwiseAbs2().allFinite()) return false;
  const Eigen::Vector3d& normal = plane_in_world_.normal;
  const Eigen::Matrix3d object_from_world =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const QuadricTangency tangency = EvaluateQuadricTangency(plane_in_world_, landmark);
  Eigen::Map<Eigen::Vector3d>(residuals) << angle_weight_ * (object_from_world * normal).head<2>(),
      tangency_weight_ * tangency.value;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;

  Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
  d_landmark.setZero();
  d_landmark.topLeftCorner<2, 3>() =
      angle_weight_ * (object_from_world * Skew(normal)).topRows<2>();
  d_landmark.row(2) = tangency_weight_ * tangency.d_landmark;
  WriteLandmarkJacobian<3>(blocks[0], d_landmark, jacobians[0]);
  return true;
}

ScaleRatioResidual::ScaleRatioResidual(const Eigen::Vector2d& ratio, double variance)
    : ratio_(ratio), weight_(1.0 / std::sqrt(variance)) {}

bool ScaleRatioResidual::Evaluate(double const* const* blocks, double* residuals,
                                  double** jacobians) const {
  const double* log_half_axes = blocks[0] + kPoseSize;
  const double a_by_c = std::exp(log_half_axes[0] - log_half_axes[2]);
  const double b_by_c = std::exp(log_half_axes[1] - log_half_axes[2]);
  if (!std::isfinite(a_by_c) || !std::isfinite(b_by_c))
    return false;  // the step was too large: the solver shortens it
  residuals[0] = weight_ * (a_by_c - ratio_.x());
  residuals[1] = weight_ * (b_by_c - ratio_.y());
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, kLandmarkSize, Eigen::RowMajor>> map(jacobians[0]);
    map.setZero();
    map.rightCols<3>() << a_by_c, 0.0, -a_by_c, 0.0, b_by_c, -b_by_c;
    map *= weight_;
  }
  return true;
}

}  // namespace soslam
