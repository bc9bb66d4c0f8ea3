// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/map_reasons.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "soslam/base/assignment.h"
#include "soslam/base/text.h"
#include "soslam/geometry/iou.h"
#include "soslam/model/label_groups.h"

namespace soslam {

Eigen::MatrixXd WorldIous(const Sequence& sequence, const AlignedMap& map) {
  Eigen::MatrixXd ious =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(map.landmarks.size()),
                            static_cast<Eigen::Index>(sequence.true_objects.size()));
  for (Eigen::Index row = 0; row < ious.rows(); ++row) {
    const AlignedLandmark& landmark = map.landmarks[row];
    for (Eigen::Index column = 0; column < ious.cols(); ++column) {
      const TrueObject& object = sequence.true_objects[column];
      if (!object.IsWanted() || object.segment != landmark.segment) continue;
      const Landmark& truth = object.truth.landmark_in_world;
      const double reach = landmark.landmark_in_world.half_axes.norm() + truth.half_axes.norm();
      if ((landmark.landmark_in_world.Centre() - truth.Centre()).norm() > reach) continue;
      ious(row, column) = CompareLandmarks(landmark.landmark_in_world, object.truth, truth).iou;
    }
  }
  return ious;
}

std::vector<int> MatchByIou(const Eigen::MatrixXd& ious, double min_iou) {
  const Eigen::MatrixXd costs = ious.unaryExpr([&](double iou) {
    return iou >= min_iou ? 1.0 - iou : std::numeric_limits<double>::infinity();
  });
  return Assign(costs, Eigen::VectorXd::Ones(ious.rows()));
}

bool IsIgnored(const Sequence& sequence, const std::string& label,
               const AlignedLandmark& landmark) {
  const auto is_in = [estimate = landmark.landmark_in_world](const Landmark& volume) {
    const double landmark_m3 = 8.0 * estimate.half_axes.prod();
    return 2.0 * IntersectionVolume(volume, estimate) >= landmark_m3 ||
           BoxIou(volume, estimate) >= kMapIous.front();
  };
  const auto has_ignored = [&](const IgnoredThings& things) {
    if (things.label && !AreSameLabel(*things.label, label)) return false;
    return !things.volume_in_world || is_in(*things.volume_in_world);
  };
  return std::ranges::any_of(sequence.ignored, has_ignored) ||
         std::ranges::any_of(sequence.true_objects, [&](const TrueObject& object) {
           return object.is_static && object.is_ignored && object.segment == landmark.segment &&
                  is_in(object.truth.landmark_in_world);
         });
}

namespace {

// Counts by kind.
using Counts = std::map<int, int>;

// The kind with more than half of the total.
std::optional<int> FindMajority(const Counts& counts, int total) {
  for (const auto& [kind, count] : counts) {
    if (2 * count > total) return kind;
  }
  return std::nullopt;
}

int Sum(const Counts& counts) {
  int sum = 0;
  for (const auto& [kind, count] : counts) sum += count;
  return sum;
}

// Counts of an object's boxes by true object (Sequence::true_objects).
struct Owners {
  int boxes = 0;
  Counts of_truth;

  // The true object of more than half of the boxes.
  std::optional<int> Majority() const { return FindMajority(of_truth, boxes); }
  bool AreMixed() const { return !Majority() && 2 * Sum(of_truth) > boxes; }
};

Owners CountOwners(const ReasonInput& input, int object_index) {
  Owners owners;
  for (size_t i = 0; i < input.sequence.detections.size(); ++i) {
    if (input.sequence.detections[i].object_index != object_index) continue;
    ++owners.boxes;
    if (const auto owner = input.views.object_of_detection[i]) ++owners.of_truth[*owner];
  }
  return owners;
}

std::string InWords(const Sequence& sequence, const Counts& of_truth) {
  std::vector<std::string> words;
  for (const auto& [index, count] : of_truth) {
    const TrueObject& object = sequence.true_objects[index];
    words.push_back(fmt::format("{} of {} ({})", count, object.id, object.label));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string InWords(const BodyErrors& errors, const std::optional<PlaneErrors>& plane) {
  std::string text = fmt::format("centre {:.3f} m, size {:+.0f} %, up {:.1f} deg", errors.centre_m,
                                 100.0 * std::expm1(errors.log_scale), errors.up_deg);
  if (errors.yaw_deg) text += fmt::format(", yaw {:.1f} deg", *errors.yaw_deg);
  if (!plane) return text;
  return text + fmt::format("; its plane {:+.3f} m, {:.1f} deg", plane->offset_m, plane->tilt_deg);
}

// `plane`: what the landmark stands on.
MapReason ChooseReason(BodyPart part, const Landmark& landmark, const std::optional<Plane>& plane,
                       const Landmark& truth) {
  switch (part) {
    case BodyPart::kPlane:
      return plane && StandsOffItsPlane(landmark, *plane, truth) ? MapReason::kWrongHeight
                                                                 : MapReason::kWrongPlane;
    case BodyPart::kSize:
      return MapReason::kWrongSize;
    case BodyPart::kYaw:
      return MapReason::kWrongYaw;
    default:
      return MapReason::kWrongPlace;
  }
}

Explanation ExplainWrong(const ReasonInput& input, int landmark, int true_index) {
  const GroundTruth& truth = input.sequence.true_objects[true_index].truth;
  const Landmark& estimate = input.map.landmarks[landmark].landmark_in_world;
  Eigen::Vector3d viewpoints = Eigen::Vector3d::Zero();  // of the cameras that observed it
  int views = 0;
  for (const Detection& detection : input.sequence.detections) {
    if (detection.object_index != input.map.landmarks[landmark].object_index) continue;
    viewpoints += input.map.world_from_camera[detection.frame_index].translation;
    ++views;
  }
  const auto wrong =
      FindDominantError(estimate, truth, truth.landmark_in_world, viewpoints / std::max(views, 1));
  const auto& plane = input.map.landmarks[landmark].plane_in_world;
  const BodyErrors errors = CompareBodies(estimate, truth, truth.landmark_in_world);
  std::optional<PlaneErrors> plane_errors;
  if (plane) plane_errors = ComparePlane(*plane, truth.landmark_in_world);
  std::string detail = fmt::format("IoU {:.3f}", errors.iou);
  if (wrong) {
    detail += fmt::format(", {:.3f} with the true {}", wrong->iou,
                          kBodyPartNames[static_cast<size_t>(wrong->part)]);
  }
  const bool is_enough = wrong && wrong->iou >= input.min_iou;
  return {is_enough ? ChooseReason(wrong->part, estimate, plane, truth.landmark_in_world)
                    : MapReason::kWrongInSeveral,
          detail + "; " + InWords(errors, plane_errors), true_index};
}

// Frames and counts of the boxes at the place of a true object: used ones by object, the others by
// reason.
struct Fates {
  std::set<int> frames, frames_in_use;
  std::set<int> frames_before_association;  // in use, or left out by association
  Counts by_object;
  std::map<std::string, int> by_reason;
};

Fates CountFates(const ReasonInput& input, int true_index) {
  Fates fates;
  for (const TrueView& view : input.views.of_object[true_index]) {
    fates.frames.insert(view.frame_index);
    if (view.detection_index) {
      const auto index = static_cast<size_t>(*view.detection_index);
      ++fates.by_object[input.sequence.detections[index].object_index];
      fates.frames_in_use.insert(view.frame_index);
      fates.frames_before_association.insert(view.frame_index);
    } else {
      const RejectedDetection& rejected = input.sequence.rejected[*view.rejected_index];
      ++fates.by_reason[rejected.reason];
      if (rejected.stage == RejectingStage::kAssociate) {
        fates.frames_before_association.insert(view.frame_index);
      }
    }
  }
  return fates;
}

}  // namespace

bool IsWrong(MapReason reason) {
  return reason >= MapReason::kWrongPlane && reason <= MapReason::kWrongInSeveral;
}

Explanation ExplainMiss(const ReasonInput& input, int true_index) {
  const Fates fates = CountFates(input, true_index);
  const int in_use = Sum(fates.by_object);
  const auto object = FindMajority(fates.by_object, in_use);
  const Owners owners = object ? CountOwners(input, *object) : Owners();
  const bool is_own = owners.Majority() == true_index;
  const std::vector<AlignedLandmark>& landmarks = input.map.landmarks;
  const auto landmark =
      std::ranges::find(landmarks, object.value_or(-1), &AlignedLandmark::object_index);
  if (is_own && landmark != landmarks.end()) {
    const auto index = static_cast<int>(landmark - landmarks.begin());
    const int match = input.truth_of_landmark[index];
    if (match == kUnassigned) return ExplainWrong(input, index, true_index);
    const TrueObject& other = input.sequence.true_objects[match];
    return {MapReason::kJoined,
            fmt::format("the landmark of its boxes matches {} ({})", other.id, other.label)};
  }
  const int detected_frames = input.views.detected_frames[true_index];
  if (detected_frames < kFewestViews) {
    return {MapReason::kNotDetected, fmt::format("boxes in {} frames", detected_frames)};
  }
  if (static_cast<int>(fates.frames.size()) < kFewestViews) {
    return {MapReason::kJoined,
            fmt::format("boxes in {} frames; in {} of them another object is nearer",
                        detected_frames, detected_frames - static_cast<int>(fates.frames.size()))};
  }
  if (static_cast<int>(fates.frames_in_use.size()) < kFewestViews) {
    const bool by_association = fates.frames_before_association.size() > fates.frames_in_use.size();
    return {by_association ? MapReason::kLostInAssociation : MapReason::kGated,
            fmt::format("boxes in use in {} frames; left out: {}", fates.frames_in_use.size(),
                        CountsInWords(fates.by_reason))};
  }
  if (!object) {
    return {MapReason::kSplit,
            fmt::format("{} boxes are of {} objects", in_use, fates.by_object.size())};
  }
  if (!is_own) {
    return {MapReason::kJoined, fmt::format("its object has boxes of several: {}",
                                            InWords(input.sequence, owners.of_truth))};
  }
  const auto estimate = std::ranges::find(input.estimates, *object, &ObjectEstimate::object_index);
  const bool has_failed = estimate != input.estimates.end() && !estimate->failure.empty();
  return {MapReason::kNoLandmark, has_failed ? estimate->failure : "not estimated"};
}

Explanation ExplainFalse(const ReasonInput& input, int landmark) {
  Eigen::Index nearest = 0;
  const double best_iou = input.ious.cols() > 0 ? input.ious.row(landmark).maxCoeff(&nearest) : 0.0;
  if (best_iou >= input.min_iou) {
    return {MapReason::kDuplicate, fmt::format("IoU {:.3f}", best_iou), static_cast<int>(nearest)};
  }
  const Owners owners = CountOwners(input, input.map.landmarks[landmark].object_index);
  if (const auto owner = owners.Majority()) {
    const TrueObject& object = input.sequence.true_objects[*owner];
    if (!object.is_static) return {MapReason::kMoving, "", *owner};
    if (object.is_ignored) {
      return {
          MapReason::kBackground,
          fmt::format("its boxes are of {} ({}), which was not asked for", object.id, object.label),
          *owner};
    }
    const bool is_found =
        std::ranges::find(input.truth_of_landmark, *owner) != input.truth_of_landmark.end();
    if (!is_found) return ExplainWrong(input, landmark, *owner);
    return {MapReason::kSplit, "another landmark matches the object of its boxes", *owner};
  }
  if (owners.AreMixed()) {
    return {MapReason::kJoined, InWords(input.sequence, owners.of_truth)};
  }
  return {MapReason::kBackground, fmt::format("{} of {} boxes are at the place of a true object",
                                              Sum(owners.of_truth), owners.boxes)};
}

}  // namespace soslam
