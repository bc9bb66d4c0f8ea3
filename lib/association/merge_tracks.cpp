// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "association/association_model.h"
#include "base/parallel.h"
#include "geometry/iou.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

constexpr int kNoObject = -1;
// A box counts as occluded when a nearer one covers this share of it.
constexpr double kHiddenShare = 0.5;

// Number of frames in which the track was detected or should have been: its outline box is inside
// the image, at least as far from the border as all detections are, at least as high as the
// smallest of the track's boxes, and not occluded by a nearer detection.
int FramesInSight(const AssociationModel& model, const Track& track, double border_px) {
  const Sequence& sequence = model.sequence();
  double smallest_height = std::numeric_limits<double>::infinity();
  std::vector<bool> is_detected(sequence.frames.size(), false);
  for (const int index : track.detections) {
    const Detection& detection = model.DetectionAt(index);
    smallest_height = std::min(smallest_height, detection.box.Height());
    is_detected[detection.frame_index] = true;
  }
  auto frames = static_cast<int>(track.detections.size());
  for (int frame = 0; frame < static_cast<int>(sequence.frames.size()); ++frame) {
    if (is_detected[frame]) continue;
    const auto prediction = model.Predict(track, frame);
    if (!prediction) continue;
    const Box& box = prediction->outline;
    const Camera& camera = sequence.CameraOf(sequence.frames[frame]);
    if (box.Height() < smallest_height ||
        DistanceToBorder(box, camera.width, camera.height) < border_px) {
      continue;
    }
    Detection expected;
    expected.frame_index = frame;
    expected.object_index = kNoObject;
    expected.box = box;
    expected.plane_in_camera = SupportPlaneOf(prediction->landmark_in_camera);
    const std::vector<Box> nearer = NearerBoxes(sequence, expected);
    const bool is_hidden = std::ranges::any_of(
        nearer, [&](const Box& by) { return CommonArea(box, by) / box.Area() >= kHiddenShare; });
    if (!is_hidden) ++frames;
  }
  return frames;
}

// Intersection over union of the boxes in each frame in which both tracks are detected.
std::vector<double> OverlapsInSharedFrames(const AssociationModel& model, const Track& one,
                                           const Track& other) {
  std::vector<double> overlaps;
  auto next = other.detections.begin();
  for (const int index : one.detections) {
    const Detection& detection = model.DetectionAt(index);
    next = std::ranges::lower_bound(next, other.detections.end(), detection.frame_index, {},
                                    [&](int i) { return model.DetectionAt(i).frame_index; });
    if (next == other.detections.end()) break;
    const Detection& of_other = model.DetectionAt(*next);
    if (of_other.frame_index != detection.frame_index) continue;
    overlaps.push_back(BoxOverlap(detection.box, of_other.box));
  }
  return overlaps;
}

// True if two tracks take up the same place, which two objects cannot: their bodies share a
// volume and, where depths are uncertain because no support is given, their boxes in the frames
// that have both overlap as well.
bool AreAtOnePlace(const AssociationModel& model, const Track& one, const Track& other,
                   const std::vector<double>& overlaps) {
  if (overlaps.empty() || !one.fit || !other.fit || !model.MayBeOneObject(one, other)) {
    return false;
  }
  const double least = model.options().same_place_overlap;
  const double sum = std::accumulate(overlaps.begin(), overlaps.end(), 0.0);
  if (!model.sequence().HasSupports() && sum < least * static_cast<double>(overlaps.size()))
    return false;
  const Landmark& a = one.fit->landmark_in_world;
  const Landmark& b = other.fit->landmark_in_world;
  const double smaller = 8.0 * std::min(a.half_axes.prod(), b.half_axes.prod());
  return IntersectionVolume(a, b) >= least * smaller;
}

std::optional<Merge> TryMerge(const AssociationModel& model, const std::vector<Track>& tracks,
                              int into, int smaller) {
  const Track& large = tracks[into];
  const Track& small = tracks[smaller];
  if (!large.fit) return std::nullopt;
  if (model.sequence().HasSupports() && large.plane_index != small.plane_index) {
    return std::nullopt;
  }
  const std::vector<int> boxes =
      SpreadOver(small.detections, static_cast<size_t>(model.options().max_views));
  const std::vector<double> overlaps = OverlapsInSharedFrames(model, large, small);
  const bool are_at_one_place = AreAtOnePlace(model, large, small, overlaps);
  Merge merge{into, 0, static_cast<int>(boxes.size()), 0, 0.0};
  const int needed =
      are_at_one_place
          ? 0
          : std::max(1,
                     static_cast<int>(std::ceil(model.options().merge_share * merge.tried - 1e-9)));
  for (int i = 0; i < merge.tried; ++i) {
    if (merge.explained + merge.tried - i < needed) return std::nullopt;
    const Detection& detection = model.DetectionAt(boxes[i]);
    const auto prediction = model.Predict(large, detection.frame_index);
    const auto match = prediction ? model.Match(large, *prediction, detection) : std::nullopt;
    if (!match) continue;
    ++merge.explained;
    merge.cost += match->cost;
  }
  if (merge.explained < needed) return std::nullopt;
  merge.shared_frames = static_cast<int>(overlaps.size());
  const double allowed =
      model.options().max_shared_frames * static_cast<double>(small.detections.size());
  if (merge.shared_frames > allowed && !are_at_one_place) return std::nullopt;
  return merge;
}

void Apply(const AssociationModel& model, const Merge& merge, int smaller,
           Association* association) {
  Track& large = association->tracks[merge.into];
  Track& small = association->tracks[smaller];
  small.fate = TrackFate::kMerged;
  small.merge = merge;
  for (const auto& [label, votes] : small.votes) large.votes[label] += votes;
  std::vector<int> all;
  const auto by_frame = [&](int detection) {
    const Detection& of_track = model.DetectionAt(detection);
    return std::tuple(of_track.frame_index, -of_track.score);
  };
  std::ranges::merge(large.detections, small.detections, std::back_inserter(all), {}, by_frame,
                     by_frame);
  large.detections.clear();
  int last_frame = -1;
  for (const int detection : all) {
    const int frame = model.DetectionAt(detection).frame_index;
    if (frame != last_frame) {
      large.detections.push_back(detection);
    } else {
      association->detections[detection].superseded = true;
    }
    last_frame = frame;
  }
}

}  // namespace

void DropFalseTracks(const AssociationModel& model, int threads, Association* association) {
  const double border_px = SmallestDistanceToBorder(model.sequence());
  ParallelFor("tracks", association->tracks.size(), threads, [&](size_t i) {
    Track& track = association->tracks[i];
    if (track.fate == TrackFate::kMerged) return;
    int three_edges = 0;  // detections that show at least three of its edges
    bool is_whole = false;
    double best_score = 0.0;
    for (const int index : track.detections) {
      const Detection& detection = model.DetectionAt(index);
      const auto hidden_edges = std::ranges::count(detection.is_one_sided, true);
      if (hidden_edges <= 1) ++three_edges;
      if (hidden_edges == 0) is_whole = true;
      best_score = std::max(best_score, detection.score);
    }
    const AssociateOptions& options = model.options();
    const bool has_detections = three_edges >= options.min_observations;
    if (track.fit && has_detections) track.frames_in_sight = FramesInSight(model, track, border_px);
    const auto fate = [&] {
      if (!has_detections) return TrackFate::kTooFewDetections;
      if (!is_whole) return TrackFate::kNeverWhole;
      if (!track.fit) return TrackFate::kNoLandmark;
      if (!track.has_support) return TrackFate::kNoSupport;
      if (model.Moves(track)) return TrackFate::kMoves;
      if (best_score < options.min_best_score) return TrackFate::kLowScores;
      const double least = options.min_detection_share * track.frames_in_sight.value();
      return static_cast<double>(track.detections.size()) < least ? TrackFate::kRarelyDetected
                                                                  : TrackFate::kObject;
    };
    track.fate = fate();
  });
}

void MergeTracks(const AssociationModel& model, int threads, Association* association) {
  std::vector<Track>& tracks = association->tracks;
  // Per track: the merge found last, and whether the track has changed since.
  std::vector<std::optional<Merge>> best(tracks.size());
  std::vector<char> has_changed(tracks.size(), 1);
  const auto rank = [](const Merge& merge) {
    return std::tuple(-merge.explained, merge.cost, merge.into);
  };
  std::vector<int> grown;
  do {
    // Tracks not yet merged, fewest detections first, the youngest first among equals.
    std::vector<int> order;
    for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
      if (tracks[i].fate != TrackFate::kMerged) order.push_back(i);
    }
    std::ranges::sort(order, {},
                      [&](int i) { return std::tuple(tracks[i].detections.size(), -i); });
    // Each is merged into one after it in the order. Results for pairs of tracks that have not
    // changed are those of the round before.
    ParallelFor("tracks", order.size(), threads, [&](size_t i) {
      std::optional<Merge>& merge = best[order[i]];
      const bool is_known = !has_changed[order[i]] && !(merge && has_changed[merge->into]);
      if (!is_known) merge.reset();
      for (size_t larger = i + 1; larger < order.size(); ++larger) {
        if (is_known && !has_changed[order[larger]]) continue;
        const auto other = TryMerge(model, tracks, order[larger], order[i]);
        if (other && (!merge || rank(*other) < rank(*merge))) merge = other;
      }
    });
    // Those of which neither track has changed in this round are carried out.
    std::ranges::fill(has_changed, 0);
    grown.clear();
    for (const int smaller : order) {
      const auto& merge = best[smaller];
      if (!merge || has_changed[smaller] || has_changed[merge->into]) continue;
      Apply(model, *merge, smaller, association);
      for (const int track : {smaller, merge->into}) has_changed[track] = 1;
      grown.push_back(merge->into);
    }
    ParallelFor(grown.size(), threads, [&](size_t i) { model.Fit(&tracks[grown[i]]); });
  } while (!grown.empty());
}

}  // namespace soslam
