// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/geometry/box.h"

namespace soslam {

// The content of associations.json: which detections were found to be of the same object, and why.
// Frames and objects are named by their ids.

// Role of a detection in its track.
enum class BoxFate {
  kAlone,        // its only box
  kExplained,    // its body explains the box
  kSecond,       // so it does, but it explains another box of the frame better
  kUnexplained,  // its body does not explain the box, which points or labels hold
  kDuplicate,    // of none: a box with a higher score covers the same place
  kByHand,       // its body does not explain the box, which edits hold
  kDeleted,      // of none: an edit deletes it
};
inline constexpr std::array kBoxFateNames = {"alone",     "explained", "second", "unexplained",
                                             "duplicate", "by_hand",   "deleted"};
inline constexpr const auto& NamesOf(BoxFate) { return kBoxFateNames; }

// The end of a track.
enum class TrackFate {
  kObject,
  kTooFewDetections,  // false: fewer than min_observations
  kRarelyDetected,    // false: in less than min_detection_share of the frames that should show it
  kNoLandmark,        // its boxes determine no landmark
  kNoSupport,         // its boxes fit better at a free height than on any support plane
  kMoves,             // its label is one of things that move
  kLowScores,         // false: none of its detections has min_best_score
  kUndetermined,      // false: its boxes determine its body less than min_overlap_by_boxes asks
  kDeleted,           // an edit deletes it
};
inline constexpr std::array kTrackFateNames = {
    "object", "too_few_detections", "rarely_detected", "no_landmark", "no_support",
    "moves",  "low_scores",         "undetermined",    "deleted"};
inline constexpr const auto& NamesOf(TrackFate) { return kTrackFateNames; }

struct Associations {
  struct DetectionName {
    int frame = 0;
    int given_object = 0;
    Box box = {};
  };
  struct Match {
    double overlap = 0.0;
    double distance_sigmas = 0.0;
    std::optional<BoxSide> cut_edge = {};
  };
  struct DetectionRow {
    DetectionName name;
    std::string label = {};
    BoxFate fate = BoxFate::kAlone;
    std::optional<Match> match = {};
    std::optional<int> track = {}, object = {};
    std::optional<DetectionName> duplicate_of = {};
  };
  struct TrackRow {
    int track = 0;
    TrackFate fate = TrackFate::kObject;
    int boxes = 0;
    int detections = 0;
    bool feet_are_hidden = false;
    std::optional<int> frames_in_sight = {};
    std::optional<double> overlap_by_boxes = {};
  };
  struct ObjectRow {
    int object = 0;
    int track = 0;
    std::string label;
    std::map<std::string, double> label_votes = {};
    int detections = 0;
    std::optional<int> given_object = {};
  };
  // Logarithms of likelihood ratios of one object against two.
  struct Evidence {
    int points_in_both = 0, points_in_any = 0;
    double points = 0.0, colours = 0.0, body = 0.0, labels = 0.0;
  };
  // Two boxes of an object.
  struct PairRow {
    int object = 0;
    DetectionName one, other;
    Evidence evidence;
  };
  // A track that is not of an object.
  struct KeptOutRow {
    int object = 0;
    int track = 0;
    int boxes = 0;
    int frames_with_both = 0;
    DetectionName nearest;
    Evidence evidence;
  };
  struct AgreementRow {
    int objects = 0;
    int given_objects = 0;
    int matched = 0;
    std::optional<double> precision = {}, recall = {}, f1 = {};
  };
  std::vector<DetectionRow> detections = {};
  std::vector<TrackRow> tracks = {};
  std::vector<ObjectRow> objects = {};
  std::vector<PairRow> held_least = {}, held_most = {};
  std::vector<KeptOutRow> kept_out = {};
  AgreementRow agreement;
};

template <typename Visitor>
void Describe(Visitor& visit, Associations::DetectionName& name) {
  visit.Field("frame", &name.frame, "id of the frame", kNotNegative);
  visit.Field("given_object", &name.given_object,
              "id of the object that the detection has in the sequence that was read, which names "
              "it with the frame; no decision looks at it");
  visit.Field("box", &name.box, "x_min, y_min, x_max, y_max, pixels of the undistorted image");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::Match& match) {
  visit.Field("overlap", &match.overlap,
              "intersection over union of the box and that of the outline of the track's body",
              kShare);
  visit.Field("distance_sigmas", &match.distance_sigmas,
              "Mahalanobis distance of the box from the outline: spread of boxes, and drift of the "
              "odometry from the frame in the middle of the track",
              kNotNegative);
  visit.Field("cut_edge", &match.cut_edge,
              "edge that was taken as cut off by something unknown, and left out of the distance");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::DetectionRow& row) {
  Describe(visit, row.name);
  visit.Field("label", &row.label, "by the detector", kNotEmpty);
  visit.Field("fate", &row.fate,
              "alone: no other box is of its track; explained: by the track's body; second: so it "
              "is, but another box of the frame better; unexplained: of the track by points or "
              "labels, against its body; duplicate: a box with a higher score covers the same "
              "place; by_hand: of the track by edits, against its body; deleted: by an edit");
  visit.Field("match", &row.match,
              "fit of the track's body to the box; null if it does not "
              "explain it");
  visit.Field("track", &row.track, "that it is of; null for duplicates and deleted boxes",
              kNotNegative);
  visit.Field("object", &row.object,
              "id of the object that it is of; null where it is not used: its own fate or that of "
              "its track says why",
              kAtLeastOne);
  visit.Field("duplicate_of", &row.duplicate_of, "the detection that it is a duplicate of");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::TrackRow& row) {
  visit.Field("track", &row.track, "position in this list, from 0", kNotNegative);
  visit.Field(
      "fate", &row.fate,
      "object: it is one; the others are false: too_few_detections; rarely_detected, for "
      "the frames that should show it; "
      "no_landmark: its boxes determine no body; no_support: they fit better at a free "
      "height than on any support plane; moves: its label is one of moving_labels; "
      "low_scores: none of its detections has min_best_score; undetermined: no image shows it "
      "whole, and overlap_by_boxes is below min_overlap_by_boxes; deleted: by an edit");
  visit.Field("boxes", &row.boxes, "all that are of it", kAtLeastOne);
  visit.Field("detections", &row.detections, "those that are used, one per frame", kAtLeastOne);
  visit.Field("feet_are_hidden", &row.feet_are_hidden,
              "something unknown hides its lower edge in most views");
  visit.Field("frames_in_sight", &row.frames_in_sight,
              "frames that should show it: in the image, near enough and not hidden; null where "
              "its fate was decided without",
              kNotNegative);
  visit.OrAbsent("overlap_by_boxes", &row.overlap_by_boxes,
                 "how well its boxes alone determine its body: expected intersection over union "
                 "with one that they allow, whatever the sizes of its label; absent where an image "
                 "shows it whole, or its fate was decided without",
                 kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::ObjectRow& row) {
  visit.Field("object", &row.object, "id in the sequence that was written", kAtLeastOne);
  visit.Field("track", &row.track, "the track that it is", kNotNegative);
  visit.Field("label", &row.label, "the most probable one of those with votes, or that of an edit",
              kNotEmpty);
  visit.Field("label_votes", &row.label_votes, "sum of the scores of its detections, by label");
  visit.Field("detections", &row.detections, "number", kAtLeastOne);
  visit.Field("given_object", &row.given_object,
              "id of the given object with which it shares the most detections, one to one, and "
              "whose ground truth it takes");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::Evidence& evidence) {
  visit.Field("points_in_both", &evidence.points_in_both,
              "points in both boxes, of points_in_any; both are sums over pairs of boxes",
              kNotNegative);
  visit.Field("points_in_any", &evidence.points_in_any,
              "points in one of the boxes or both that both images show", kNotNegative);
  visit.Field("points", &evidence.points,
              "what these points say: logarithm of the likelihood ratio of one object against two, "
              "which all pairs of a box share");
  visit.Field("colours", &evidence.colours, "the same of the colours in the boxes, at most 0");
  visit.Field(
      "body", &evidence.body,
      "the same of the boxes where the object's body predicts them, against boxes anywhere");
  visit.Field("labels", &evidence.labels,
              "the same of their labels for the labels of the object, against any label");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::PairRow& row) {
  visit.Field("object", &row.object, "id in the sequence that was written", kAtLeastOne);
  visit.Field("one", &row.one, "a box of it");
  visit.Field("other", &row.other, "another one, of a later frame");
  visit.Field("evidence", &row.evidence, "of the pair; body and labels: of the two boxes, summed");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::KeptOutRow& row) {
  visit.Field("object", &row.object, "id in the sequence that was written", kAtLeastOne);
  visit.Field("track", &row.track, "that is not of it", kNotNegative);
  visit.Field("boxes", &row.boxes, "of the track", kAtLeastOne);
  visit.Field("frames_with_both", &row.frames_with_both,
              "in which both have a box, which speaks for two objects", kNotNegative);
  visit.Field("nearest", &row.nearest,
              "box of the track that points and colours tie most to the object");
  visit.Field("evidence", &row.evidence,
              "points and colours: summed over all pairs of a box of the object and one of the "
              "track; body and "
              "labels: mean over boxes of the track, at most 8");
}

template <typename Visitor>
void Describe(Visitor& visit, Associations::AgreementRow& agreement) {
  visit.Field("objects", &agreement.objects, "found ones", kNotNegative);
  visit.Field("given_objects", &agreement.given_objects,
              "objects of the sequence that was read that stand still, with at least "
              "min_observations detections",
              kNotNegative);
  visit.Field("matched", &agreement.matched,
              "pairs that share more than half of the detections that either has", kNotNegative);
  visit.Field("precision", &agreement.precision, "matched / objects; null without given objects",
              kShare);
  visit.Field("recall", &agreement.recall, "matched / given_objects", kShare);
  visit.Field("f1", &agreement.f1, "their harmonic mean", kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, Associations& associations) {
  visit.Field("detections", &associations.detections,
              "all detections of the sequence that was read, in its order");
  visit.Field("tracks", &associations.tracks, "in the order of their first detections");
  visit.Field("objects", &associations.objects, "of the sequence that was written, by id");
  visit.Field("held_least", &associations.held_least,
              "the pairs that hold each object together least, at most 3, by points and colours, "
              "then by body "
              "and labels; the weakest of all objects first");
  visit.Field("held_most", &associations.held_most,
              "those that hold it together most, the strongest first");
  visit.Field("kept_out", &associations.kept_out,
              "the tracks that came nearest to being of each object, at most 3, by the sum of the "
              "evidence; the nearest of all objects first");
  visit.Field("agreement", &associations.agreement, "of the objects with the given ones");
  visit.Check([&] {
    const auto tracks = std::ssize(associations.tracks);
    std::vector<std::pair<std::string, int>> named;
    for (const Associations::ObjectRow& row : associations.objects) {
      named.emplace_back("object " + std::to_string(row.object) + " is of", row.track);
    }
    for (const Associations::DetectionRow& row : associations.detections) {
      if (row.track) named.emplace_back("a detection is of", *row.track);
    }
    for (const Associations::KeptOutRow& row : associations.kept_out) {
      named.emplace_back("object " + std::to_string(row.object) + " is without", row.track);
    }
    for (const auto& [what, track] : named) {
      if (track < tracks) continue;
      return what + " track " + std::to_string(track) + " of " + std::to_string(tracks) +
             "; expected one in the list";
    }
    return std::string();
  });
}

}  // namespace soslam
