// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "association/fit_object.h"
#include "association/labels.h"
#include "association/options.h"
#include "association/up_estimate.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// What became of a detection when its frame was looked at.
enum class LinkDecision {
  kNewTrack,   // no track explained it better than an object that was never seen would
  kLinked,     // to a track that was in the image all the time since it was last seen
  kRevisited,  // linked to a track that was out of the image in between
  kDuplicate,  // in the frame is a box at the same place with a higher score
};
inline constexpr std::array kLinkDecisionNames = {"new_track", "linked", "revisited", "duplicate"};

struct DetectionDecision {
  LinkDecision decision = LinkDecision::kNewTrack;
  int track = -1;  // into Association::tracks; -1: none
  // Of links: how the track explained the box, and when it was seen before.
  double overlap = 0.0;   // intersection over union of the box and that of the landmark's outline
  double distance = 0.0;  // from the expected box, in standard deviations
  std::optional<int> cut_edge;  // left, top, right, bottom: taken as cut off by something unknown
  int frames_since_seen = 0;
  int duplicate_of = -1;    // into Sequence::detections
  int object = -1;          // into Association::objects; -1: not used
  bool superseded = false;  // not used, as the merged object has another box in the frame
};

// What became of a track.
enum class TrackFate {
  kObject,
  kMerged,            // into another track, which explains enough of its boxes
  kTooFewDetections,  // false: fewer than min_observations
  kRarelyDetected,    // false: in less than min_detection_share of the frames that should show it
  kNoLandmark,        // its boxes determine no body
};
inline constexpr std::array kTrackFateNames = {"object", "merged", "too_few_detections",
                                               "rarely_detected", "no_landmark"};

// A sequence of detections that were linked frame by frame.
struct Track {
  std::vector<int> detections;  // into Sequence::detections, frames ascending; merged ones included
  int linked = 0;               // how many of them before merging
  int plane_index = 0;
  LabelVotes votes;
  std::optional<FittedObject> fit;
  TrackFate fate = TrackFate::kObject;
  // Merged: into which track, which explained so many of the boxes it was tried on, and in how many
  // frames both had been detected.
  int merged_into = -1;
  int explained = 0;
  int tried = 0;
  int shared_frames = 0;
  std::optional<int>
      frames_in_sight;  // that should show it; none when its fate was decided without
};

struct Association {
  std::vector<DetectionDecision> detections;  // one per Sequence::detections
  std::vector<Track> tracks;
  std::vector<int> objects;                  // into `tracks`, by their first detection
  std::map<int, UpEstimate> up_of_segments;  // empty: planes are known
};

// The sequence as if nobody knew what its objects stand on.
Sequence WithoutPlanes(Sequence sequence);

// Finds out which detections are of the same object, from boxes, labels, scores, poses and, where
// the sequence has them, support planes alone: neither objects nor their ids are looked at, but for
// the label and plane that each detection has through its own. The frames are gone through in
// order: each one's detections are assigned to the tracks so far, or start new ones, as is most
// likely. Then tracks are merged that turn out to be one object, and false ones dropped. Throws
// SettingsError for malformed interchangeable_labels.
Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const AssociateOptions& options, int threads);

}  // namespace soslam
