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

// Why a true object has no landmark, or a landmark no true object.
enum class MapReason {
  kNotDetected,        // boxes overlap it in fewer than kFewestViews frames
  kGated,              // so many boxes, but most were left out before association
  kLostInAssociation,  // most were left out by association
  kSplit,              // boxes are spread over several objects, or another landmark has it already
  kJoined,             // boxes are, or are taken for, those of several true objects
  kNoLandmark,         // the object has boxes enough, and no estimate
  kWrongPlane,         // a landmark of its boxes is elsewhere, for the plane that it stands on
  kWrongHeight,        // or for its height over that
  kWrongSize,
  kWrongYaw,
  kWrongPlace,
  kWrongInSeveral,  // so that no part alone helps
  kDuplicate,       // a landmark at the place of one that matches better
  kMoving,          // its boxes are of an object that moves
  kBackground,      // its boxes are of no true object
};
inline constexpr std::array kMapReasonNames = {
    "not_detected", "gated",       "lost_in_association", "split",
    "joined",       "no_landmark", "wrong_plane",         "wrong_height",
    "wrong_size",   "wrong_yaw",   "wrong_place",         "wrong_in_several",
    "duplicate",    "moving",      "background"};
// Whether the landmark is that of the true object, at another place.
bool IsWrong(MapReason reason);

struct Explanation {
  MapReason reason = MapReason::kNotDetected;
  std::string detail;                             // with its numbers, for a person
  std::optional<int> true_object = std::nullopt;  // of a false landmark: into true_objects
};

// What a map and its sequence say, looked through backwards. `truth_of_landmark` is MatchByIou's.
struct ReasonInput {
  const Sequence& sequence;
  const std::vector<ObjectEstimate>& estimates;
  const AlignedMap& map;
  const ViewsOfTruth& views;
  const Eigen::MatrixXd& ious;
  const std::vector<int>& truth_of_landmark;
  double min_iou = 0.0;
};

// Why a true object matches no landmark.
Explanation ExplainMiss(const ReasonInput& input, int true_index);
// Why a landmark, which is not ignored, matches no true object.
Explanation ExplainFalse(const ReasonInput& input, int landmark);

// FindWrongPart of a landmark and a true object of its segment.
std::optional<WrongPart> PartToBlame(const Sequence& sequence, const AlignedMap& map, int landmark,
                                     int true_index);

}  // namespace soslam
