// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/detection.h"

#include <cmath>

namespace soslam {

DetectionResidual::DetectionResidual(const Camera& camera, const Box& box, double variance)
    : weight_(1.0 / std::sqrt(variance)) {
  const auto lines = box.EdgeLines();
  for (size_t i = 0; i < lines.size(); ++i) {
    normals_in_camera_[i] = camera.BackProject(lines[i]).normal;
  }
}

bool DetectionResidual::Evaluate(double const* const* blocks, double* residuals,
                                 double** jacobians) const {
  const RelativeObservation observation(blocks);
  const Landmark& landmark = observation.landmark_in_camera();
  const Eigen::Matrix3d object_from_camera =
      landmark.frame_from_object.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d squared_axes = landmark.half_axes.cwiseAbs2();
  if (!squared_axes.allFinite()) return false;  // the step was too large: the solver shortens it

  Eigen::Matrix<double, 4, kLandmarkDof> d_landmark;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d& normal = normals_in_camera_[i];
    const Eigen::Vector3d normal_in_object = object_from_camera * normal;
    const Eigen::Vector3d weighted = squared_axes.cwiseProduct(normal_in_object);
    const double distance = normal.dot(landmark.Centre());
    residuals[i] = weight_ * (weighted.dot(normal_in_object) - distance * distance);
    d_landmark.row(i) << 2.0 * weighted.transpose() * object_from_camera * Skew(normal),
        -2.0 * distance * normal.transpose(),
        2.0 * weighted.cwiseProduct(normal_in_object).transpose();
  }
  observation.WriteJacobians<4>(weight_ * d_landmark, blocks, jacobians);
  return true;
}

}  // namespace soslam
