// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/quadric_tangency.h"

namespace soslam {

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

}  // namespace soslam
