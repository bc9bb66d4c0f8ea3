// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/detection.h"

#include <cmath>

#include "constraints/quadric_tangency.h"

namespace soslam {

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

}  // namespace soslam
