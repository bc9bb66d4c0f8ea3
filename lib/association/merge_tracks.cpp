// SPDX-License-Identifier: BSD-3-Clause
#include "association/merge_tracks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/parallel.h"

namespace soslam {
namespace {

// Candidate merge of a smaller track into a larger one.
struct Merge {
  int into = -1;
  int explained = 0;
  int tried = 0;
  int shared_frames = 0;
  double cost = 0.0;  // sum over the explained boxes

  bool IsBetterThan(const Merge& other) const {
    return std::tuple(-explained, cost, into) <
           std::tuple(-other.explained, other.cost, other.into);
  }
};

class TrackMerger {
 public:
  TrackMerger(const AssociationModel& model, int threads, Association* association)
      : model_(model),
        threads_(threads),
        association_(*association),
        best_(association->tracks.size()),
        has_changed_(association->tracks.size(), 1) {}

  void Run() {
    while (MergeOnce()) {
    }
  }

 private:
  const Detection& At(int detection) const {
    return model_.sequence().detections[static_cast<size_t>(detection)];
  }
  Track& TrackAt(int track) { return association_.tracks[static_cast<size_t>(track)]; }
  const Track& TrackAt(int track) const { return association_.tracks[static_cast<size_t>(track)]; }

  // Tracks not yet merged, fewest detections first, the youngest first among equals.
  std::vector<int> SmallestFirst() const {
    std::vector<int> order;
    for (int i = 0; i < static_cast<int>(association_.tracks.size()); ++i) {
      if (TrackAt(i).fate != TrackFate::kMerged) order.push_back(i);
    }
    std::ranges::sort(order, {},
                      [&](int i) { return std::tuple(TrackAt(i).detections.size(), -i); });
    return order;
  }

  bool HasChanged(int track) const { return has_changed_[static_cast<size_t>(track)] != 0; }

  // The best track to merge this one into, among those after it in the order. Reuses the previous
  // result for pairs of tracks that have not changed.
  std::optional<Merge> BestMerge(const std::vector<int>& order, size_t position) const {
    const int smaller = order[position];
    std::optional<Merge> best = best_[static_cast<size_t>(smaller)];
    const bool is_known = !HasChanged(smaller) && !(best && HasChanged(best->into));
    if (!is_known) best.reset();
    for (size_t larger = position + 1; larger < order.size(); ++larger) {
      if (is_known && !HasChanged(order[larger])) continue;
      const auto merge = TryMerge(order[larger], smaller);
      if (merge && (!best || merge->IsBetterThan(*best))) best = merge;
    }
    return best;
  }

  // Finds the best merge of each track and applies those in which neither track has changed in this
  // round. Returns whether any were applied.
  bool MergeOnce() {
    const std::vector<int> order = SmallestFirst();
    std::vector<std::optional<Merge>> merges(order.size());
    ParallelFor("tracks", static_cast<int>(order.size()), threads_, [&](int i) {
      merges[static_cast<size_t>(i)] = BestMerge(order, static_cast<size_t>(i));
    });
    std::ranges::fill(has_changed_, 0);
    std::vector<int> grown;
    for (size_t i = 0; i < order.size(); ++i) {
      const auto& merge = best_[static_cast<size_t>(order[i])] = merges[i];
      if (!merge || HasChanged(order[i]) || HasChanged(merge->into)) continue;
      Apply(*merge, order[i]);
      for (const int track : {order[i], merge->into}) has_changed_[static_cast<size_t>(track)] = 1;
      grown.push_back(merge->into);
    }
    ParallelFor(static_cast<int>(grown.size()), threads_,
                [&](int i) { model_.Fit(&TrackAt(grown[static_cast<size_t>(i)])); });
    return !grown.empty();
  }

  std::optional<Merge> TryMerge(int into, int smaller) const {
    const Track& large = TrackAt(into);
    const Track& small = TrackAt(smaller);
    if (large.plane_index != small.plane_index || !large.fit) return std::nullopt;
    const std::vector<int> boxes =
        SpreadOver(small.detections, static_cast<size_t>(model_.options().max_views));
    Merge merge{into, 0, static_cast<int>(boxes.size()), 0, 0.0};
    const int needed =
        std::max(1, static_cast<int>(std::ceil(model_.options().merge_share * merge.tried - 1e-9)));
    for (int i = 0; i < merge.tried; ++i) {
      if (merge.explained + merge.tried - i < needed) return std::nullopt;
      const Detection& detection = At(boxes[static_cast<size_t>(i)]);
      const auto prediction = model_.Predict(large, detection.frame_index);
      const auto match = prediction ? model_.Match(large, *prediction, detection) : std::nullopt;
      if (!match) continue;
      ++merge.explained;
      merge.cost += match->cost;
    }
    if (merge.explained < needed) return std::nullopt;
    merge.shared_frames = SharedFrames(large, small);
    const double allowed =
        model_.options().max_shared_frames * static_cast<double>(small.detections.size());
    if (merge.shared_frames > allowed) return std::nullopt;
    return merge;
  }

  int SharedFrames(const Track& one, const Track& other) const {
    const auto frames_of = [this](const Track& track) {
      std::vector<int> frames;
      for (const int detection : track.detections) frames.push_back(At(detection).frame_index);
      return frames;
    };
    std::vector<int> shared;
    std::ranges::set_intersection(frames_of(one), frames_of(other), std::back_inserter(shared));
    return static_cast<int>(shared.size());
  }

  void Apply(const Merge& merge, int smaller) {
    Track& large = TrackAt(merge.into);
    Track& small = TrackAt(smaller);
    small.fate = TrackFate::kMerged;
    small.merged_into = merge.into;
    small.explained = merge.explained;
    small.tried = merge.tried;
    small.shared_frames = merge.shared_frames;
    for (const auto& [label, votes] : small.votes) large.votes[label] += votes;
    std::vector<int> all;
    const auto by_frame = [this](int detection) {
      return std::tuple(At(detection).frame_index, -At(detection).score);
    };
    std::ranges::merge(large.detections, small.detections, std::back_inserter(all), {}, by_frame,
                       by_frame);
    large.detections.clear();
    for (const int detection : all) {
      const bool is_first = large.detections.empty() ||
                            At(large.detections.back()).frame_index != At(detection).frame_index;
      if (is_first) {
        large.detections.push_back(detection);
      } else {
        association_.detections[static_cast<size_t>(detection)].superseded = true;
      }
    }
  }

  const AssociationModel& model_;
  int threads_;
  Association& association_;
  // Per track: the merge found last, and whether the track has changed since.
  std::vector<std::optional<Merge>> best_;
  std::vector<char> has_changed_;
};

}  // namespace

void MergeTracks(const AssociationModel& model, int threads, Association* association) {
  TrackMerger(model, threads, association).Run();
}

}  // namespace soslam
