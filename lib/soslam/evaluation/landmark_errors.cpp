// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/landmark_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {
namespace {

// Renaming of a box's axes: of the 24 rotations of the cube, the one from the new names to the old
// ones that leaves the smallest angle (rad) to the axes of the truth.
struct NearestAxes {
  Eigen::Matrix3d old_from_new;
  double angle = 0.0;
};

NearestAxes FindNearestAxes(const Eigen::Quaterniond& frame_from_estimate,
                            const Eigen::Quaterniond& frame_from_truth) {
  const Eigen::Matrix3d truth_from_estimate =
      (frame_from_truth.conjugate() * frame_from_estimate).toRotationMatrix();
  NearestAxes nearest{Eigen::Matrix3d::Identity(), std::numbers::pi};
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d cube = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) {
        cube(i, axes[i]) = (signs >> i & 1) != 0 ? -1.0 : 1.0;
      }
      if (cube.determinant() < 0.0) continue;
      const Eigen::Quaterniond difference(Eigen::Matrix3d(truth_from_estimate * cube));
      const double angle = LogRotation(difference.normalized()).norm();
      if (angle < nearest.angle) nearest = {cube, angle};
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return nearest;
}

// The yaw (rad) of the estimate's x axis in the frame of the truth; a quarter turn where it is
// along the truth's z axis.
double YawInTruth(const Eigen::Quaterniond& frame_from_estimate,
                  const Eigen::Quaterniond& frame_from_truth) {
  const Eigen::Vector3d x_axis =
      frame_from_truth.conjugate() * (frame_from_estimate * Eigen::Vector3d::UnitX());
  if (x_axis.head<2>().norm() < 1e-9) return std::numbers::pi / 2.0;
  return std::atan2(x_axis.y(), x_axis.x());
}

// The landmark, rotated about its z axis until its x axis points as that of `other` does.
Landmark AlignYaw(const Landmark& other, const Landmark& landmark) {
  const Eigen::Vector3d front = landmark.frame_from_object.rotation.conjugate() *
                                (other.frame_from_object.rotation * Eigen::Vector3d::UnitX());
  return RotatedAboutZ(landmark, std::atan2(front.y(), front.x()));
}

Eigen::Vector3d Up(const Landmark& landmark) {
  return landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
}

// Contact point: the centre of the base.
Eigen::Vector3d Foot(const Landmark& landmark) {
  return landmark.Centre() - landmark.half_axes.z() * Up(landmark);
}

Landmark WithFootAt(Landmark landmark, const Eigen::Vector3d& foot) {
  landmark.frame_from_object.translation = foot + landmark.half_axes.z() * Up(landmark);
  return landmark;
}

// The estimate with its axes renamed to be nearest those of the truth.
Landmark NamedLike(const Landmark& estimate, const Landmark& truth) {
  const Eigen::Quaterniond& rotation = estimate.frame_from_object.rotation;
  const Eigen::Matrix3d old_from_new =
      FindNearestAxes(rotation, truth.frame_from_object.rotation).old_from_new;
  Landmark named = estimate;
  named.frame_from_object.rotation = (rotation * Eigen::Quaterniond(old_from_new)).normalized();
  named.half_axes = old_from_new.cwiseAbs().transpose() * estimate.half_axes;
  return named;
}

}  // namespace

double RotationError(const Eigen::Quaterniond& frame_from_estimate,
                     const Eigen::Quaterniond& frame_from_truth) {
  return FindNearestAxes(frame_from_estimate, frame_from_truth).angle;
}

double YawError(const Eigen::Quaterniond& frame_from_estimate,
                const Eigen::Quaterniond& frame_from_truth) {
  return std::abs(YawDifferenceModuloPi(YawInTruth(frame_from_estimate, frame_from_truth), 0.0));
}

double AttitudeError(const Landmark& estimate, const Landmark& truth_in_frame) {
  const Eigen::Quaterniond own_difference =
      InOwnAxes(truth_in_frame).frame_from_object.rotation.conjugate() *
      InOwnAxes(estimate).frame_from_object.rotation;
  // The coefficients of a rotation are the cosines of half the angles that are left after half
  // turns about x, y and z, and after none.
  return 2.0 * std::acos(std::min(1.0, own_difference.coeffs().cwiseAbs().maxCoeff()));
}

LandmarkErrors CompareLandmarks(const Landmark& estimate, const GroundTruth& truth,
                                const Landmark& truth_in_frame) {
  LandmarkErrors errors;
  errors.centre_m = (estimate.Centre() - truth_in_frame.Centre()).norm();
  if (truth.rotationally_symmetric) {
    errors.iou = BoxIou(estimate, AlignYaw(estimate, truth_in_frame));
    return errors;
  }
  const Eigen::Quaterniond& estimated = estimate.frame_from_object.rotation;
  const Eigen::Quaterniond& exact = truth_in_frame.frame_from_object.rotation;
  errors.iou = BoxIou(estimate, truth_in_frame);
  errors.rotation_deg = kDegPerRad * RotationError(estimated, exact);
  errors.yaw_deg = kDegPerRad * YawError(estimated, exact);
  errors.attitude_deg = kDegPerRad * AttitudeError(estimate, truth_in_frame);
  return errors;
}

BodyErrors CompareBodies(const Landmark& estimate, const GroundTruth& truth,
                         const Landmark& truth_in_frame) {
  const Landmark named = NamedLike(estimate, truth_in_frame);
  const LandmarkErrors own = CompareLandmarks(estimate, truth, truth_in_frame);
  BodyErrors errors;
  errors.iou = own.iou;
  errors.centre_m = own.centre_m;
  errors.centre_relative = own.centre_m / (2.0 * MeanHalfAxis(truth_in_frame));
  errors.log_size = named.half_axes.cwiseQuotient(truth_in_frame.half_axes).array().log();
  errors.log_scale = errors.log_size.mean();
  errors.up_deg = AngleBetweenDeg(Up(estimate), Up(truth_in_frame));
  if (truth.rotationally_symmetric) return errors;
  errors.yaw_deg = kDegPerRad * YawError(named.frame_from_object.rotation,
                                         truth_in_frame.frame_from_object.rotation);
  const Eigen::Vector3d front = named.frame_from_object.rotation.conjugate() *
                                (estimate.frame_from_object.rotation * Eigen::Vector3d::UnitX());
  errors.is_quarter_turned = std::abs(front.y()) > 0.5;
  return errors;
}

LandmarkErrors CompareInCamera(const Landmark& estimate, const GroundTruth& truth,
                               const Landmark& truth_in_camera) {
  const auto iou = [&](const Landmark& corrected) {
    return CompareLandmarks(corrected, truth, truth_in_camera).iou;
  };
  LandmarkErrors errors = CompareLandmarks(estimate, truth, truth_in_camera);
  const Landmark named = NamedLike(estimate, truth_in_camera);
  Landmark placed = estimate, sized = named;
  placed.frame_from_object.translation = truth_in_camera.Centre();
  sized.half_axes = truth_in_camera.half_axes;
  errors.what_if = {errors.iou, errors.iou, iou(placed), iou(sized)};
  if (truth.rotationally_symmetric) return errors;
  errors.what_if->yaw =
      std::max(iou(AlignYaw(truth_in_camera, estimate)), iou(AlignYaw(truth_in_camera, named)));
  // Boxes are symmetric to half turns, which leaves two of the four.
  errors.what_if->quarter_turn =
      std::max(errors.iou, iou(RotatedAboutZ(named, 0.5 * std::numbers::pi)));
  return errors;
}

FrontError CompareFronts(const ObjectEstimate& estimate, const Landmark& aligned,
                         const GroundTruth& truth) {
  if (!estimate.front_probability || !truth.MayHaveFront()) return {};
  const double yaw = YawInTruth(aligned.frame_from_object.rotation,
                                truth.landmark_in_world.frame_from_object.rotation);
  return {kDegPerRad * std::abs(yaw), estimate.FrontIsKnown()};
}

std::optional<FrontSummary> SummariseFronts(const std::vector<FrontError>& fronts) {
  const std::vector<double> errors = CollectValues(fronts, &FrontError::deg);
  if (errors.empty()) return std::nullopt;
  const auto is_right = [](double deg) { return deg < 30.0; };
  const auto is_wrong = [](const FrontError& front) { return front.is_known && front.deg > 45.0; };
  FrontSummary summary;
  summary.objects = static_cast<int>(errors.size());
  summary.deg_mean = *MeanOf(errors);
  summary.deg_median = *MedianOf(errors);
  summary.share_below_30_deg =
      static_cast<double>(std::ranges::count_if(errors, is_right)) / summary.objects;
  summary.known = static_cast<int>(std::ranges::count_if(fronts, &FrontError::is_known));
  summary.known_but_wrong = static_cast<int>(std::ranges::count_if(fronts, is_wrong));
  return summary;
}

PlaneErrors ComparePlane(const Plane& plane, const Landmark& truth) {
  return {-plane.SignedDistance(Foot(truth)), AngleBetweenDeg(plane.normal, Up(truth))};
}

bool StandsOffItsPlane(const Landmark& estimate, const Plane& plane, const Landmark& truth) {
  return std::abs(plane.SignedDistance(Foot(estimate))) >
         std::abs(plane.SignedDistance(Foot(truth)));
}

std::optional<WrongPart> FindDominantError(const Landmark& estimate, const GroundTruth& truth,
                                           const Landmark& truth_in_frame,
                                           const Eigen::Vector3d& camera_centre) {
  constexpr double kLeastGain = 1e-6;  // in IoU by the correction of a part
  const Landmark named = NamedLike(estimate, truth_in_frame);
  const auto iou = [&](const Landmark& corrected) {
    return CompareLandmarks(corrected, truth, truth_in_frame).iou;
  };
  const Eigen::Vector3d foot = Foot(named), up = Up(truth_in_frame);
  // Upright, and moved onto the true plane: straight, or along the line of sight if that meets it.
  const Plane plane = ComputeSupportPlane(truth_in_frame);
  Landmark upright = named;
  upright.frame_from_object.rotation =
      (RotationBetween(Up(named), up) * named.frame_from_object.rotation).normalized();
  double on_plane = iou(WithFootAt(upright, foot - plane.SignedDistance(foot) * up));
  const double camera_height = plane.SignedDistance(camera_centre);
  const double factor = camera_height / (camera_height - plane.SignedDistance(foot));
  if (std::isfinite(factor) && factor > 0.0) {
    upright.half_axes *= factor;
    on_plane = std::max(on_plane,
                        iou(WithFootAt(upright, camera_centre + factor * (foot - camera_centre))));
  }
  Landmark sized = named;
  sized.half_axes = truth_in_frame.half_axes;
  const Eigen::Vector3d shift = Foot(truth_in_frame) - foot;
  const std::array candidates = {
      WrongPart{BodyPart::kPlane, on_plane},
      WrongPart{BodyPart::kSize, iou(WithFootAt(sized, foot))},
      WrongPart{BodyPart::kYaw, iou(AlignYaw(truth_in_frame, named))},
      WrongPart{BodyPart::kPlace, iou(WithFootAt(named, foot + shift - up.dot(shift) * up))}};
  const WrongPart& best = *std::ranges::max_element(candidates, {}, &WrongPart::iou);
  return best.iou > iou(named) + kLeastGain ? std::optional(best) : std::nullopt;
}

}  // namespace soslam
