// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "soslam/association/association.h"
#include "soslam/association/clustering.h"
#include "soslam/model/edits.h"
#include "soslam/model/finding.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Edits with the detections that their anchors name (indices in Sequence::detections).
struct FoundEdits {
  const Edits& edits;
  std::vector<std::vector<int>> boxes;  // of each edit, in the order of its anchors
  std::map<int, int> deleted;           // detections that an edit deletes, with the edit's index
};

// Finds the detection of each anchor: the one of its image with the largest overlap. One that is a
// duplicate stands for the detection that it repeats. Keeps a reference. Throws InputError, naming
// the edit, for an anchor of an unknown image, without a detection, or with two that fit it
// alike, and for an edit of a box that another one deletes.
FoundEdits FindBoxes(const Edits& edits, const Sequence& sequence,
                     const std::vector<DetectionDecision>& decisions);

// Edits whose object no body fits, and which therefore change nothing in the map.
std::vector<Finding> CheckEdits(const Sequence& sequence, const Association& association);

// The clusters as edits have them. First boxes that are split off leave their clusters, for a
// cluster of their own, then clusters that are joined become one. Clusters that an edit names are
// `by_hand`; new ones have no body yet. Throws InputError for edits that contradict each other, or
// that join boxes of different segments.
std::vector<Cluster> WithEdits(const AssociationModel& model, const FoundEdits& found,
                               std::vector<Cluster> clusters);

}  // namespace soslam
