// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "association/box_likelihood.h"
#include "association/fit_track.h"
#include "association/labels.h"
#include "association/options.h"
#include "association/up_estimate.h"
#include "model/associations.h"
#include "model/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

struct DetectionDecision {
  LinkDecision decision = LinkDecision::kNewTrack;
  int track = -1;  // index in Association::tracks; -1: none
  // Fit of the track to the box and time since its last detection; for links only. A cut edge is
  // treated as cut off by an unknown occluder.
  BoxMatch match;
  int frames_since_seen = 0;
  int duplicate_of = -1;    // index in Sequence::detections
  int object = -1;          // index in Association::objects; -1: not used
  bool superseded = false;  // not used: the merged object has a better box in the frame
};

// Merge of a smaller track into a larger one.
struct Merge {
  int into = -1;          // index of the larger track
  int explained = 0;      // number of the smaller one's boxes that the larger one fits
  int tried = 0;          // number of boxes that were tested
  int shared_frames = 0;  // number of frames in which both have a detection
  double cost = 0.0;      // sum over the explained boxes
};

// Detections of one object, linked frame by frame.
struct Track {
  // Indices in Sequence::detections, ascending by frame; includes those of merged tracks.
  std::vector<int> detections;
  int linked = 0;  // number of detections before merging
  int plane_index = 0;
  LabelVotes votes;
  std::vector<LabelProbability> labels;  // most probable first
  std::optional<FittedObject> fit;
  bool has_support = true;  // false: see TrackFate::kNoSupport
  TrackFate fate = TrackFate::kObject;
  Merge merge;  // for TrackFate::kMerged
  // Number of frames that should show the object; none when it was not needed to decide the fate.
  std::optional<int> frames_in_sight;
};

// The most probable label that the track has votes for, or else that it may have.
const std::string& LabelOf(const Track& track);

struct Association {
  std::vector<DetectionDecision> detections;  // one per Sequence::detections
  std::vector<Track> tracks;
  std::vector<int> objects;  // indices in `tracks`, ordered by first detection
  // One entry for each segment; empty when support planes are given.
  std::map<int, UpEstimate> up_of_segments;
};

// The sequence without support planes.
Sequence WithoutPlanes(Sequence sequence);

// Estimates which detections belong to the same object from boxes, labels, scores, poses and, if
// given, support planes. The given objects and their ids are not used, except for the label and
// plane of each detection. In frame order, the detections of each frame are assigned to existing
// tracks or start new ones by maximum likelihood. Then tracks of the same object are merged and
// false ones dropped. Throws SettingsError for malformed interchangeable_labels.
Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const AssociateOptions& options, int threads);

}  // namespace soslam
