// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "soslam/association/box_likelihood.h"
#include "soslam/association/fit_track.h"
#include "soslam/association/labels.h"
#include "soslam/association/options.h"
#include "soslam/association/pair_evidence.h"
#include "soslam/association/up_estimate.h"
#include "soslam/model/associations.h"
#include "soslam/model/edits.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"

namespace soslam {

struct DetectionDecision {
  BoxFate fate = BoxFate::kAlone;
  int track = -1;  // index in Association::tracks; -1: none
  // Fit of the track's body to the box, if it explains it. A cut edge is treated as cut off by
  // something unknown.
  std::optional<BoxMatch> match;
  int duplicate_of = -1;  // index in Sequence::detections
  int object = -1;        // index in Association::objects; -1: not used
};

// A track's edits.
struct ByHand {
  // Boxes of the object, whether they fit or not: those that edits join or split, which come before
  // others of their frames; and what else these edits make one object of, which comes after them.
  std::set<int> named, grouped;
  bool is_deleted = false;
  std::optional<std::string> label = {};
  KnownSize size = {};
};

// Detections of one thing.
struct Track {
  // Indices in Sequence::detections, ascending by frame; of a finished track those that are used,
  // one per frame.
  std::vector<int> detections;
  std::vector<int> boxes;  // of a finished track: all of them, also those that are not used
  int plane_index = 0;
  LabelVotes votes;
  std::vector<LabelProbability> labels;  // most probable first
  std::optional<FittedObject> fit;
  std::string fit_label;    // label whose prior the fit has
  double prior_cost = 0.0;  // -2 log of what prior and support say of the fit
  bool has_support = true;  // false: see TrackFate::kNoSupport
  TrackFate fate = TrackFate::kObject;
  // Number of frames that should show the object; none when it was not needed to decide the fate.
  std::optional<int> frames_in_sight;
  // OverlapByBoxes; none where an image shows it whole, or it was not needed to decide the fate.
  std::optional<double> overlap_by_boxes;
  // Empty: no edit names it. Otherwise it is an object, however rarely it is seen, unless it is
  // deleted or has no body.
  std::optional<ByHand> by_hand;
};

// The most probable label that the track has votes for, or else that it may have.
const std::string& LabelOf(const Track& track);

// Two objects, by their indices in Association::objects, that are probably one thing.
struct MovedThing {
  int object;
  int later_object;
  int frames_left = 0;     // that show the first place without it, since it was at the second one
  int frames_not_yet = 0;  // that show the second place without it, while it was at the first one
  double probability = 0.0;
};

struct Association {
  std::vector<DetectionDecision> detections;  // one per Sequence::detections
  std::vector<Track> tracks;
  std::vector<int> objects;  // indices in `tracks`, ordered by first detection
  std::vector<MovedThing> moved_things;
  bool is_settled = true;  // see Clusters
  // One entry for each segment; empty when support planes are given.
  std::map<int, UpEstimate> up_of_segments;
  // The evidence that decided about the objects, see AddDecisiveEvidence.
  std::vector<Associations::PairRow> held_least, held_most;
  std::vector<Associations::KeptOutRow> kept_out;
};

// The detections without those of lower score that nearly coincide with another one in their frame.
// `decisions` has one entry for each detection; those of duplicates are set.
std::vector<int> WithoutDuplicates(const Sequence& sequence, double duplicate_overlap,
                                   std::vector<DetectionDecision>* decisions);

// The sequence without support planes.
Sequence WithoutPlanes(Sequence sequence);

// Estimates which detections belong to the same object from boxes, labels, scores, poses, shared
// points and, if given, support planes. The given objects and their ids are not used, except for
// the label and plane of each detection. All boxes are grouped at once (ClusterDetections), each
// group's body explains them once more as any label that it may have, and false ones are dropped.
// Edits change the groups (WithEdits). Throws SettingsError for malformed interchangeable_labels,
// InputError for edits that fit no box or contradict each other.
Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const PairEvidence& pairs, const AssociateOptions& options, int threads,
                      const Edits& edits = {});

}  // namespace soslam
