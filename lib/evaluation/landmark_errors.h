// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "geometry/landmark.h"
#include "model/truth.h"

namespace soslam {

// Errors of one landmark. Rotation and yaw are absent for rotationally symmetric objects, whose yaw
// has no meaning; for IoU the truth is then rotated to the estimate's yaw.
struct LandmarkErrors {
  double iou = 0.0;
  double centre_m = 0.0;
  std::optional<double> rotation_deg;  // RotationError
  std::optional<double> yaw_deg;       // YawError
};

LandmarkErrors CompareLandmarks(const Landmark& estimate, const GroundTruth& truth,
                                const Landmark& truth_in_frame);

}  // namespace soslam
