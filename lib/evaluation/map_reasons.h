// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/aligned_map.h"
#include "evaluation/body_errors.h"
#include "evaluation/true_views.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Reasons for a true object without landmark, or a landmark without true object.
enum class MapReason {
  kNotDetected,        // boxes overlap it in fewer than kFewestViews frames
  kGated,              // so many boxes, but in use in fewer, and none left out by association
  kLostInAssociation,  // the same, and association left boxes out in other frames
  kSplit,              // boxes are spread over several objects, or another landmark has it already
  kJoined,             // boxes are, or are taken for, those of several true objects
  kNoLandmark,         // the object has boxes enough, and no estimate
  kWrongPlane,         // a landmark of its boxes is elsewhere, for the plane that it stands on
  kWrongHeight,        // or for its height over that
  kWrongSize,
  kWrongYaw,
  kWrongPlace,
  kWrongInSeveral,  // no single correction makes it match
  kDuplicate,       // overlaps a true object that another landmark matches better
  kMoving,          // its boxes belong to a moving object
  kBackground,      // at most half of its boxes belong to true objects that are looked for
};
inline constexpr std::array kMapReasonNames = {
    "not_detected", "gated",       "lost_in_association", "split",
    "joined",       "no_landmark", "wrong_plane",         "wrong_height",
    "wrong_size",   "wrong_yaw",   "wrong_place",         "wrong_in_several",
    "duplicate",    "moving",      "background"};
// True for a landmark of the true object that does not match it: plane, height, size, yaw or place.
bool IsWrong(MapReason reason);

struct Explanation {
  MapReason reason = MapReason::kNotDetected;
  std::string detail;                             // with numbers, for a person
  std::optional<int> true_object = std::nullopt;  // for a false landmark: into true_objects
};

// Data to explain a map's errors. `truth_of_landmark` is the result of MatchByIou.
struct ReasonInput {
  const Sequence& sequence;
  const std::vector<ObjectEstimate>& estimates;
  const AlignedMap& map;
  const ViewsOfTruth& views;
  const Eigen::MatrixXd& ious;
  const std::vector<int>& truth_of_landmark;
  double min_iou = 0.0;
};

// Reason for a true object without a matching landmark.
Explanation ExplainMiss(const ReasonInput& input, int true_index);
// Reason for a landmark, which is not ignored, without a matching true object.
Explanation ExplainFalse(const ReasonInput& input, int landmark);

// FindDominantError of a landmark and a true object of its segment.
std::optional<WrongPart> DominantError(const Sequence& sequence, const AlignedMap& map,
                                       int landmark, int true_index);

}  // namespace soslam
