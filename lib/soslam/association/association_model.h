// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "soslam/association/association.h"
#include "soslam/association/box_likelihood.h"
#include "soslam/association/fit_track.h"
#include "soslam/association/labels.h"
#include "soslam/association/options.h"
#include "soslam/association/up_estimate.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Models shared by all steps of data association: landmark fit, predicted box, and likelihood of
// box and label. Keeps references.
class AssociationModel {
 public:
  AssociationModel(const Sequence& sequence, const SemanticTable& table,
                   const AssociateOptions& options);

  const Sequence& sequence() const { return sequence_; }
  const AssociateOptions& options() const { return options_; }
  const LabelConfusion& labels() const { return labels_; }
  const std::map<int, UpEstimate>& up_of_segments() const { return up_of_segments_; }
  const Detection& DetectionAt(int index) const { return sequence_.detections[index]; }
  const std::string& LabelOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).label;
  }
  int PlaneOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).plane_index;
  }

  // Fits the track's landmark to its detections, once for each label that it is detected with and,
  // where its support plane is unknown, each plane; then as similar labels from the best of these
  // landmarks, on its support. Boxes, sizes and votes decide among them. When the boxes determine
  // no landmark, the track keeps its previous one. Whether it has a support is asked of the former
  // labels, and of the one that was decided for.
  void Fit(Track* track) const;
  // Fits a track with the labels and supports of its parts alone, which have been fitted; if there
  // are at most two parts, from their landmarks.
  void FitLike(const std::vector<const Track*>& parts, Track* track) const;
  // Fits a track, as similar labels only where its own fit worse by more than a change of label
  // costs, without asking whether the track has a support.
  void FitAsDetected(Track* track) const;

  // Expected box of a track in a frame. None when the track has no landmark, its landmark is not
  // entirely in front of the camera, or the frame is of another segment. Odometry drift is counted
  // from the nearest frame in which the track was detected.
  std::optional<Prediction> Predict(const Track& track, int frame_index) const;

  // Likelihood of a detection's box and label given the track. None when an unseen object is more
  // likely, or the detection is on another plane.
  std::optional<BoxMatch> Match(const Track& track, const Prediction& prediction,
                                const Detection& detection) const;
  // True if both may be in one place: they are of one segment and, if supports are known, on one
  // plane.
  bool MayShareSupport(const Track& one, const Track& other) const;
  // The match of each of the track's boxes by its own landmark, which is taken as exact in the
  // frame in the middle of the track, from which drift is counted.
  std::vector<std::optional<BoxMatch>> Explain(const Track& track) const;
  // True if the segment of two tracks is the same and the detector may give the labels of the other
  // track to an object like the first.
  bool MayBeOneObject(const Track& one, const Track& other) const;
  // OverlapByBoxes of a track that has a landmark.
  double OverlapByBoxes(const Track& track) const;
  // True if the label of a track is one of things that move.
  bool Moves(const Track& track) const;
  // Cost of assigning the detection to an unseen object, comparable to BoxMatch::cost.
  double NewObjectCost(const Detection& detection) const;
  // Cost of assigning the detection to a track whose landmark does not explain its box.
  double UnexplainedCost(const Track& track, const Detection& detection) const;

 private:
  int SegmentOf(const Track& track) const;
  std::optional<Prediction> Predict(const Track& track, const FittedObject& fit,
                                    int known_frame_index, int frame_index) const;
  // Costs of the labels and supports that a track may have; its best fit on a support.
  struct Hypotheses {
    std::map<std::string, double> cost_of_label;
    double cost = std::numeric_limits<double>::infinity();
    double cost_at_free_height = std::numeric_limits<double>::infinity();
    std::optional<FittedObject> fit;
    double prior_cost = 0.0;
    int plane_index = kNoPlane;
    std::string label;
  };
  std::vector<Support> ListSupports(const Track& track) const;
  void Try(const Track& track, const std::string& label, const Support& support,
           const std::vector<Landmark>& starts, Hypotheses* hypotheses) const;
  // Labels that the track is detected with, or the one given by hand, on each support.
  void TryOwnLabels(const Track& track, Hypotheses* hypotheses) const;
  // Labels similar to those, from the best landmark on its support; where there is none yet, on
  // each support.
  void TrySimilar(const Track& track, Hypotheses* hypotheses) const;
  void TryFreeHeight(const Track& track, const std::string& label, Hypotheses* hypotheses) const;
  double CostOfLabel(const Track& track, const std::string& label, const FittedObject& fit) const;
  ShapePrior MakePrior(const Track& track, const std::string& label) const;
  void Settle(const Hypotheses& hypotheses, Track* track) const;

  const Sequence& sequence_;
  const SemanticTable& table_;
  const AssociateOptions& options_;
  std::map<int, UpEstimate> up_of_segments_;  // keyed by segment; empty when planes are given
  BoxLikelihood boxes_;
  LabelConfusion labels_;
  std::set<std::string> moving_labels_;  // normalised
};

// Decides which of the tracks are objects, and sets the fate of all.
void DropFalseTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam
