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

// What all decisions on detections and tracks rest on. Keeps references.
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

  // Fits the track's landmark to its detections, with the prior of its label; when they determine
  // none, the track keeps the one it has.
  void Fit(Track* track) const;

  // Where a track is expected in a frame; none when it has no landmark, or not wholly in front of
  // the camera, or the frame is of another segment. Its landmark is good for the nearest frame in
  // which it was detected.
  std::optional<Prediction> Predict(const Track& track, int frame_index) const;

  // How a track explains a detection, with its label; none when it is more likely of an object that
  // nothing is known of, or on another plane.
  std::optional<Explanation> Explain(const Track& track, const Prediction& prediction,
                                     const Detection& detection) const;
  // Explanation::cost of an object that nothing is known of.
  double NewObjectCost(const Detection& detection) const;

 private:
  int SegmentOf(const Track& track) const;

  const Sequence& sequence_;
  const SemanticTable& table_;
  const AssociateOptions& options_;
  std::map<int, UpEstimate> up_of_segments_;  // empty: planes are known
  BoxLikelihood boxes_;
  LabelConfusion labels_;
};

}  // namespace soslam
