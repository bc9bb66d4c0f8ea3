// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/support.h"

#include <cmath>

#include "constraints/quadric_tangency.h"

namespace soslam {

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

}  // namespace soslam
