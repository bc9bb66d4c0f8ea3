// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/association/association_model.h"
#include "soslam/association/pair_evidence.h"

namespace soslam {

// Boxes taken to be of one object.
struct Cluster {
  Track track;                                   // with all boxes
  std::vector<std::optional<BoxMatch>> matches;  // of each box by the track's body
  std::vector<bool> is_used;                     // each box: explained, and the best in its frame
  double log_ratio = 0.0;  // of one object against as many as boxes, by pictures
  double cost = 0.0;       // -2 log of the evidence
};

// For each box of a track: true if it is the one that the body explains best in its frame. Boxes
// with an edge that is not the object's come after all others.
std::vector<bool> BestInFrames(const AssociationModel& model, const Track& track,
                               const std::vector<std::optional<BoxMatch>>& matches);

struct Clusters {
  std::vector<Cluster> all;  // also of single boxes
  bool is_settled = true;    // false: the limit of rounds was reached before the cost settled
};

// Groups detections (indices in Sequence::detections) into objects. The cost of a cluster is -2 log
// of the evidence that its boxes are of one object: Laplace's approximation of its body's evidence,
// where one of the boxes counts as that of an unseen object, and PairEvidence. Tracklets of boxes
// in neighbouring frames that no other box rivals are joined wherever that lowers the sum of all
// costs, first with the others that promise most, the largest gain first. Then boxes that their
// body does not explain, and halves that are held together least, leave their cluster where that
// lowers it, in turn with further joins, until nothing does.
Clusters ClusterDetections(const AssociationModel& model, const PairEvidence& pairs,
                           const std::vector<int>& detections, int threads);

// The sum that ClusterDetections lowers, of groups of detections that are given: the costs of
// clusters, each with the body of the label that fits best, and of bodies in one place.
double CostOfGroups(const AssociationModel& model, const PairEvidence& pairs,
                    const std::vector<std::vector<int>>& groups, int threads);

}  // namespace soslam
