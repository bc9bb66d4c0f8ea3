// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "soslam/evaluation/alignment.h"
#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/true_views.h"
#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Intersections over unions of boxes in the world: rows are the map's landmarks, columns the true
// objects; unwanted true objects and those of other segments have 0. Bodies of
// rotation take the landmark's yaw.
Eigen::MatrixXd WorldIous(const Sequence& sequence, const AlignedMap& map);

// The true object of each landmark, or kUnassigned: one to one, so that the sum of their IoUs is
// maximal, among pairs with at least this IoU. Labels and ids are ignored.
std::vector<int> MatchByIou(const Eigen::MatrixXd& ious, double min_iou);

// True if a landmark is neither right nor wrong: its label is ignored everywhere, or it is in the
// volume of ignored things or of an ignored true object, with half of its own volume at least or
// with an IoU at which it would match a true object there.
bool IsIgnored(const Sequence& sequence, const std::string& label, const AlignedLandmark& landmark);

// True for a landmark of the true object that does not match it: plane, height, size, yaw or place.
bool IsWrong(MapReason reason);

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

}  // namespace soslam
