// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "soslam/association/edits.h"
#include "soslam/association/pair_evidence.h"
#include "soslam/association/up_estimate.h"
#include "soslam/ground/horizontal_planes.h"
#include "soslam/ground/options.h"
#include "soslam/ground/scale_posterior.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Frames (indices, ascending) whose boxes are grouped: those with boxes, 200 of them evenly spread
// over more, and all whose boxes edits name.
std::vector<int> FramesToGroup(const Sequence& sequence, const FoundEdits& edits);

// Detections (indices in Sequence::detections) in groups, ascending, each of one object and with
// one box per frame: clusters of association in the normalised world, without boxes that their body
// does not explain. Heights of labels say as much of the objects' sizes there as is known of that
// world's unit.
std::vector<std::vector<int>> GroupBoxes(Sequence sequence, const std::vector<int>& frames,
                                         const FoundEdits& edits, const SemanticTable& table,
                                         const PairEvidence& pairs, const UpPrior& up,
                                         const GroundOptions& options, int threads);

// Boxes of one object.
struct BoxGroup {
  std::vector<int> detections;  // indices in Sequence::detections, ascending
  KnownSize size = {};          // what a person measured
};

// The groups with the sizes of edits. The boxes that an edit names are of one object, with all that
// the group with most of them has, unless that has a size by another edit, which names more. Edits
// that name a common box are of one object.
std::vector<BoxGroup> WithSizes(const FoundEdits& edits,
                                const std::vector<std::vector<int>>& groups);

// An object of one group of boxes, with the scale by its heights on each of the planes, and at a
// free height, under each of its labels that has a height in the table. The known length of an
// object that a person measured takes the place of its height.
struct MeasuredObject {
  std::vector<int> detections;  // indices in Sequence::detections
  KnownSize size;
  std::map<std::string, double> votes;  // share of each label in the scores
  ScaleEvidence evidence;               // no hypotheses where no body fits the boxes
  std::vector<Landmark> landmarks;      // in the world, one per hypothesis
  std::optional<double> pull = {};      // see ScalePosterior
};

// Fits an upright body to the boxes of each group, on each plane and at a free height. `frames`:
// those whose boxes were grouped.
std::vector<MeasuredObject> MeasureObjects(const Sequence& sequence, const std::vector<int>& frames,
                                           const std::vector<BoxGroup>& groups,
                                           const SemanticTable& table,
                                           const HorizontalPlanes& planes,
                                           const GroundOptions& options, int threads);

// The settings of association with which bodies are fitted and up is found.
AssociateOptions FitOptions(const GroundOptions& options);

}  // namespace soslam
