// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "association/fit_object.h"
#include "association/labels.h"
#include "association/options.h"
#include "association/up_estimate.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// Result of linking one detection to the tracks of earlier frames.
enum class LinkDecision {
  kNewTrack,   // no track fits it better than an unseen object does
  kLinked,     // to a track that stayed in the image since its last detection
  kRevisited,  // to a track that left the image since its last detection
  kDuplicate,  // dropped: a box with a higher score covers the same place
};
inline constexpr std::array kLinkDecisionNames = {"new_track", "linked", "revisited", "duplicate"};

struct DetectionDecision {
  LinkDecision decision = LinkDecision::kNewTrack;
  int track = -1;  // index in Association::tracks; -1: none
  // Fit of the track to the box and time since its last detection; for links only.
  double overlap = 0.0;   // intersection over union of the box and the landmark's outline box
  double distance = 0.0;  // Mahalanobis distance to the expected box
  // Edge (left, top, right, bottom) that is treated as cut off by an unknown occluder.
  std::optional<int> cut_edge;
  int frames_since_seen = 0;
  int duplicate_of = -1;    // index in Sequence::detections
  int object = -1;          // index in Association::objects; -1: not used
  bool superseded = false;  // not used: the merged object has a better box in the frame
};

// Result of a track after merging and removal of false tracks.
enum class TrackFate {
  kObject,
  kMerged,            // into another track that fits enough of its boxes
  kTooFewDetections,  // false: fewer than min_observations
  kRarelyDetected,    // false: in less than min_detection_share of the frames that should show it
  kNoLandmark,        // its boxes determine no landmark
  kNoSupport,         // its boxes fit better at a free height than on any support plane
  kMoves,             // its label is one of things that move
  kLowScores,         // false: none of its detections has min_best_score
  kNeverWhole,        // false: none of its detections shows all edges
};
inline constexpr std::array kTrackFateNames = {
    "object",     "merged", "too_few_detections", "rarely_detected", "no_landmark",
    "no_support", "moves",  "low_scores",         "never_whole"};

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
  // Set by merging: the track that this one was merged into, the number of boxes that track fits
  // (`explained`) of those tested (`tried`), and the number of frames in which both have a
  // detection.
  int merged_into = -1;
  int explained = 0;
  int tried = 0;
  int shared_frames = 0;
  // Number of frames that should show the object; none when it was not needed to decide the fate.
  std::optional<int> frames_in_sight;
};

// The most probable label that the track has votes for, or else that it may have.
const std::string& LabelOf(const Track& track);

struct Association {
  std::vector<DetectionDecision> detections;  // one per Sequence::detections
  std::vector<Track> tracks;
  std::vector<int> objects;  // indices in `tracks`, ordered by first detection
  // Keyed by segment; empty when support planes are given.
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

// Models shared by all steps of data association: landmark fit, predicted box, and likelihood of
// box and label. Keeps references.
class AssociationModel {
 public:
  AssociationModel(const Sequence& sequence, const SemanticTable& table,
                   const AssociateOptions& options);

  const Sequence& sequence() const { return sequence_; }
  const AssociateOptions& options() const { return options_; }
  const std::map<int, UpEstimate>& up_of_segments() const { return up_of_segments_; }
  const Detection& DetectionAt(int index) const { return sequence_.detections[index]; }
  const std::string& LabelOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).label;
  }
  int PlaneOf(const Detection& detection) const {
    return sequence_.ObjectOf(detection).plane_index;
  }

  // Fits the track's landmark to its detections, once for each label that it may have and, where
  // its support plane is unknown, each plane. Boxes, sizes and votes decide among them. When the
  // boxes determine no landmark, the track keeps its previous one.
  void Fit(Track* track) const;

  // Expected box of a track in a frame. None when the track has no landmark, its landmark is not
  // entirely in front of the camera, or the frame is of another segment. Odometry drift is counted
  // from the nearest frame in which the track was detected.
  std::optional<Prediction> Predict(const Track& track, int frame_index) const;

  // Likelihood of a detection's box and label given the track. None when an unseen object is more
  // likely, or the detection is on another plane.
  std::optional<BoxMatch> Match(const Track& track, const Prediction& prediction,
                                const Detection& detection) const;
  // True if the segment of two tracks is the same and the detector may give the labels of the other
  // track to an object like the first.
  bool MayBeOneObject(const Track& one, const Track& other) const;
  // True if the label of a track is one of things that move.
  bool Moves(const Track& track) const;
  // Cost of assigning the detection to an unseen object, comparable to BoxMatch::cost.
  double NewObjectCost(const Detection& detection) const;

 private:
  int SegmentOf(const Track& track) const;
  // What the track may stand on.
  std::vector<Support> SupportsOf(const Track& track) const;
  // Costs of the labels and supports that a track may have; its best fit on a support.
  struct Hypotheses {
    std::map<std::string, double> cost_of_label;
    double cost = std::numeric_limits<double>::infinity();
    double cost_at_free_height = std::numeric_limits<double>::infinity();
    std::optional<FittedObject> fit;
    int plane_index = kNoPlane;
  };
  void Try(const Track& track, const std::string& label, Hypotheses* hypotheses) const;

  const Sequence& sequence_;
  const SemanticTable& table_;
  const AssociateOptions& options_;
  std::map<int, UpEstimate> up_of_segments_;  // keyed by segment; empty when planes are given
  BoxLikelihood boxes_;
  LabelConfusion labels_;
  std::set<std::string> moving_labels_;  // normalised
};

// Agreement of the estimated objects with the objects given in the sequence.
struct Agreement {
  // For each estimated object the index of its given object in Sequence::objects. One to one,
  // assigned greedily by the number of shared detections; none when no remaining given object
  // shares a detection.
  std::vector<std::optional<int>> given_of_object;
  // Number of static given objects with at least min_observations detections, and number of pairs
  // of such an object and an estimated one whose intersection over union of detections is above
  // 0.5.
  int given_objects = 0;
  int matched = 0;

  // Shares of the estimated and of the given objects that are matched, and their harmonic mean.
  // None without given objects.
  std::optional<double> Precision() const;
  std::optional<double> Recall() const;
  std::optional<double> F1() const;
};
Agreement CompareWithGiven(const Sequence& sequence, const Association& association,
                           int min_observations);

// The sequence with the estimated objects (ids from 1) in place of the given ones. Keeps the
// detections of these objects; all others are counted as rejected. Each object takes the ground
// truth of its given object, if that is static, for evaluation.
Sequence AssociatedSequence(const Sequence& sequence, const Association& association,
                            const Agreement& agreement);

// Assigns, frame by frame, the detections to existing tracks (at most one per track) or to new
// tracks at the least total cost. Fills Association::detections and Association::tracks.
Association LinkFrames(const AssociationModel& model, int threads);

// Decides which of the tracks left after merging are objects, and sets the fate of all.
void DropFalseTracks(const AssociationModel& model, int threads, Association* association);

// Merges tracks of the same object: the larger track's landmark fits at least merge_share of the
// smaller one's boxes (at most max_views of them, evenly spread), and the two are detected in the
// same frame in at most max_shared_frames of the smaller one's frames; or their bodies take up the
// same place (same_place_overlap). Smallest tracks first, each
// into the one that fits most of its boxes, until no pair is left to merge. Where a merged object
// has two detections in a frame, the one with the lower score is superseded. Landmarks of grown
// tracks are refitted.
void MergeTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam
