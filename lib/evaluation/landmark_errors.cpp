// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/landmark_errors.h"

#include <cmath>

#include "evaluation/iou.h"
#include "evaluation/rotation_error.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

// The landmark, rotated about its z axis until its x axis points as the estimate's does.
Landmark WithYawOf(const Landmark& estimate, const Landmark& landmark) {
  const Eigen::Vector3d front = landmark.frame_from_object.rotation.conjugate() *
                                (estimate.frame_from_object.rotation * Eigen::Vector3d::UnitX());
  return RotatedAboutZ(landmark, std::atan2(front.y(), front.x()));
}

}  // namespace

LandmarkErrors CompareLandmarks(const Landmark& estimate, const GroundTruth& truth,
                                const Landmark& truth_in_frame) {
  LandmarkErrors errors;
  errors.centre_m = (estimate.Centre() - truth_in_frame.Centre()).norm();
  if (truth.rotationally_symmetric) {
    errors.iou = BoxIou(estimate, WithYawOf(estimate, truth_in_frame));
    return errors;
  }
  const Eigen::Quaterniond& estimated = estimate.frame_from_object.rotation;
  const Eigen::Quaterniond& exact = truth_in_frame.frame_from_object.rotation;
  errors.iou = BoxIou(estimate, truth_in_frame);
  errors.rotation_deg = kDegPerRad * RotationError(estimated, exact);
  errors.yaw_deg = kDegPerRad * YawError(estimated, exact);
  return errors;
}

}  // namespace soslam
