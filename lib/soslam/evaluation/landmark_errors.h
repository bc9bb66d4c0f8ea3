// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// The paper's Rot, rad: the smallest rotation that brings the estimate's three axes onto any axes
// of the truth, over the 24 rotations of the cube. It does not detect quarter turns.
double RotationError(const Eigen::Quaterniond& frame_from_estimate,
                     const Eigen::Quaterniond& frame_from_truth);

// The angle (rad, in [0, pi/2]) between the x axes about the truth's z axis, modulo half a turn:
// the mirror plane has no front or back. pi/2 when the estimate's x axis is the truth's z axis.
double YawError(const Eigen::Quaterniond& frame_from_estimate,
                const Eigen::Quaterniond& frame_from_truth);

// The smallest rotation (rad) that brings the estimate's own axes (InOwnAxes) onto those of the
// truth up to half turns, to which bodies are symmetric. It detects quarter turns and objects that
// rest on another face.
double AttitudeError(const Landmark& estimate, const Landmark& truth_in_frame);

// Errors of one landmark. Angles are absent for rotationally symmetric objects, whose yaw has no
// meaning; for IoU the truth is then rotated to the estimate's yaw.
struct LandmarkErrors {
  double iou = 0.0;
  double centre_m = 0.0;
  std::optional<double> rotation_deg;  // RotationError
  std::optional<double> yaw_deg;       // YawError
  std::optional<double> attitude_deg;  // AttitudeError
  std::optional<WhatIf> what_if;       // by CompareInCamera only
};

LandmarkErrors CompareLandmarks(const Landmark& estimate, const GroundTruth& truth,
                                const Landmark& truth_in_frame);
// Errors in the frame of a camera, where those of its pose do not count, with `what_if`.
LandmarkErrors CompareInCamera(const Landmark& estimate, const GroundTruth& truth,
                               const Landmark& truth_in_camera);

// Means over the items that have a WhatIf: `what_if_of` is a member or function.
template <typename Items, typename WhatIfOf>
std::optional<WhatIf> MeanWhatIf(const Items& items, const WhatIfOf& what_if_of) {
  WhatIf mean;
  for (const auto iou : {&WhatIf::yaw, &WhatIf::quarter_turn, &WhatIf::place, &WhatIf::size}) {
    const auto value = MeanOf(CollectValues(items, [&](const auto& item) {
      const std::optional<WhatIf> what_if = std::invoke(what_if_of, item);
      return what_if ? std::optional((*what_if).*iou) : std::nullopt;
    }));
    if (!value) return std::nullopt;
    mean.*iou = *value;
  }
  return mean;
}

BodyErrors CompareBodies(const Landmark& estimate, const GroundTruth& truth,
                         const Landmark& truth_in_frame);

// The error of the estimate's front, whose landmark `aligned` is in the world of the truth.
FrontError CompareFronts(const ObjectEstimate& estimate, const Landmark& aligned,
                         const GroundTruth& truth);
// Empty without errors.
std::optional<FrontSummary> SummariseFronts(const std::vector<FrontError>& fronts);

PlaneErrors ComparePlane(const Plane& plane, const Landmark& truth);

// True if the estimate is farther from the plane that it should stand on than the truth is: its
// height is then wrong, not the plane.
bool StandsOffItsPlane(const Landmark& estimate, const Plane& plane, const Landmark& truth);

// The parts that make up a body on its plane.
enum class BodyPart {
  kPlane,  // the up direction and the height of the contact point
  kSize,
  kYaw,
  kPlace,  // the contact point's position on the plane
};
inline constexpr const char* kBodyPartNames[] = {"plane", "size", "yaw", "place"};

// The part with the largest error: its correction alone raises IoU most.
struct WrongPart {
  BodyPart part = BodyPart::kPlane;
  double iou = 0.0;  // with the part corrected
};
// `camera_centre`: approximate viewpoint. An object whose plane is corrected moves straight onto
// it, or along the line of sight with its size scaled, as an object would whose boxes had been
// placed on that plane: whichever gives the higher IoU. None if no single correction helps.
std::optional<WrongPart> FindDominantError(const Landmark& estimate, const GroundTruth& truth,
                                           const Landmark& truth_in_frame,
                                           const Eigen::Vector3d& camera_centre);

}  // namespace soslam
