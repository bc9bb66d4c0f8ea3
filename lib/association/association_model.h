// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "association/association.h"
#include "association/box_likelihood.h"
#include "association/labels.h"
#include "association/up_estimate.h"

namespace soslam {

// Models shared by all steps of data association: landmark fit, predicted box, and likelihood of
// box and label. Keeps references.
class AssociationModel {
 public:
  AssociationModel(const Sequence& sequence, const SemanticTable& table,
                   const AssociateOptions& options);

  const Sequence& sequence() const { return sequence_; }
  const AssociateOptions& options() const { return options_; }
  const std::map<int, UpEstimate>& up_of_segments() const { return up_of_segments_; }
  const std::string& LabelOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).label;
  }
  int PlaneOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).plane_index;
  }

  // Fits the track's landmark to its detections with the prior of its label. When they determine no
  // landmark, the track keeps its previous one.
  void Fit(Track* track) const;

  // Expected box of a track in a frame. None when the track has no landmark, its landmark is not
  // entirely in front of the camera, or the frame is of another segment. Odometry drift is counted
  // from the nearest frame in which the track was detected.
  std::optional<Prediction> Predict(const Track& track, int frame_index) const;

  // Likelihood of a detection's box and label given the track. None when an unseen object is more
  // likely, or the detection is on another plane.
  std::optional<BoxMatch> Match(const Track& track, const Prediction& prediction,
                                const Detection& detection) const;
  // Cost of assigning the detection to an unseen object, comparable to BoxMatch::cost.
  double NewObjectCost(const Detection& detection) const;

 private:
  int SegmentOf(const Track& track) const;

  const Sequence& sequence_;
  const SemanticTable& table_;
  const AssociateOptions& options_;
  std::map<int, UpEstimate> up_of_segments_;  // keyed by segment; empty when planes are given
  BoxLikelihood boxes_;
  LabelConfusion labels_;
};

}  // namespace soslam
