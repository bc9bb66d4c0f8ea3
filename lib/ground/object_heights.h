// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "association/edits.h"
#include "association/up_estimate.h"
#include "ground/horizontal_planes.h"
#include "ground/options.h"
#include "ground/scale_posterior.h"
#include "model/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// Detections (indices in Sequence::detections) in groups, ascending, each of one object. The
// upright rectangle that a box shows, at the depth of the points in it or of a plane under its
// lower edge, predicts the boxes of its object in all other frames. Rectangles are chosen in the
// order of how many boxes agree with them. Boxes whose depth is unknown and that agree with none
// are in no group.
std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes, int threads);

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

// Fits an upright body to the boxes of each group, on each plane and at a free height.
std::vector<MeasuredObject> MeasureObjects(const Sequence& sequence,
                                           const std::vector<BoxGroup>& groups,
                                           const SemanticTable& table,
                                           const HorizontalPlanes& planes, const UpEstimate& up,
                                           const GroundOptions& options, int threads);

// The settings of association with which bodies are fitted and up is found.
AssociateOptions FitOptions(const GroundOptions& options);

}  // namespace soslam
