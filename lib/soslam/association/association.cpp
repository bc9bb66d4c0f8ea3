// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/association.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "soslam/association/association_model.h"
#include "soslam/association/clustering.h"
#include "soslam/association/decisive_evidence.h"
#include "soslam/association/edits.h"
#include "soslam/association/moved_things.h"
#include "soslam/base/parallel.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

// The track of a cluster. If its body explains enough boxes for an object, it is fitted once more
// to these, as any label that it may have; then all boxes are explained by this body.
Track Finished(const AssociationModel& model, const Cluster& cluster,
               std::vector<DetectionDecision>* decisions) {
  Track track = cluster.track;
  const std::vector<int>& boxes = track.boxes = track.detections;
  std::vector<std::optional<BoxMatch>> matches = cluster.matches;
  std::vector<bool> is_used = cluster.is_used;
  // A body for the object that a person names, even if none explained any of its boxes before.
  if (track.by_hand && std::ranges::count(is_used, true) == 0) is_used.assign(boxes.size(), true);
  const auto use = [&] {
    track.detections.clear();
    for (size_t i = 0; i < boxes.size(); ++i) {
      if (is_used[i]) track.detections.push_back(boxes[i]);
    }
  };
  use();
  std::vector<std::optional<BoxMatch>> candidates = matches;
  if (track.by_hand ||
      static_cast<int>(track.detections.size()) >= model.options().min_observations) {
    if (track.by_hand) track.fit.reset();
    model.Fit(&track);
    track.detections = boxes;
    candidates = matches = model.Explain(track);
    for (size_t i = 0; i < boxes.size() && track.by_hand; ++i) {
      constexpr double kMostCost = 1e9;  // more than any match costs
      if (track.by_hand->named.contains(boxes[i])) {
        candidates[i].emplace().cost = (matches[i] ? matches[i]->cost : 0.0) - kMostCost;
      } else if (track.by_hand->grouped.contains(boxes[i]) && !matches[i]) {
        candidates[i] = BoxMatch{0.0, 0.0, BoxSide::kLeft, kMostCost};  // after all matches
      }
    }
    const std::vector<bool> used_before =
        std::exchange(is_used, BestInFrames(model, track, candidates));
    use();
    if (is_used != used_before && !track.detections.empty()) model.Fit(&track);
  }
  if (track.detections.empty()) {
    track.detections = boxes;
    track.fit.reset();
  }
  for (size_t i = 0; i < boxes.size(); ++i) {
    DetectionDecision& decision = (*decisions)[boxes[i]];
    decision.match = matches[i];
    decision.fate = boxes.size() == 1             ? BoxFate::kAlone
                    : is_used[i] && !matches[i]   ? BoxFate::kByHand
                    : is_used[i]                  ? BoxFate::kExplained
                    : matches[i] || candidates[i] ? BoxFate::kSecond
                                                  : BoxFate::kUnexplained;
  }
  return track;
}

}  // namespace

std::vector<int> WithoutDuplicates(const Sequence& sequence, double duplicate_overlap,
                                   std::vector<DetectionDecision>* decisions) {
  std::vector<int> kept;
  for (int frame = 0; frame < static_cast<int>(sequence.frames.size()); ++frame) {
    std::vector<int> detections;
    for (const Detection& detection : DetectionsIn(sequence, frame)) {
      detections.push_back(static_cast<int>(&detection - sequence.detections.data()));
    }
    // Ties are ordered by box and label, so that the order and ids of the input do not matter.
    std::ranges::stable_sort(detections, {}, [&](int index) {
      const Detection& detection = sequence.detections[index];
      const Box& box = detection.box;
      return std::tuple(-detection.score, box.x_min, box.y_min, box.x_max, box.y_max,
                        sequence.ObjectOf(detection).label);
    });
    const size_t first = kept.size();
    for (const int index : detections) {
      const auto same = std::find_if(
          kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(), [&](int other) {
            return BoxOverlap(sequence.detections[index].box, sequence.detections[other].box) >=
                   duplicate_overlap;
          });
      if (same == kept.end()) {
        kept.push_back(index);
      } else {
        (*decisions)[index].fate = BoxFate::kDuplicate;
        (*decisions)[index].duplicate_of = *same;
      }
    }
  }
  return kept;
}

Sequence WithoutPlanes(Sequence sequence) {
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const PairEvidence& pairs, const AssociateOptions& options, int threads,
                      const Edits& edits) {
  const AssociationModel model(sequence, table, options);
  Association association;
  association.detections.resize(sequence.detections.size());
  std::vector<int> kept =
      WithoutDuplicates(sequence, options.duplicate_overlap, &association.detections);
  const FoundEdits found = FindBoxes(edits, sequence, association.detections);
  std::erase_if(kept, [&](int detection) { return found.deleted.contains(detection); });
  for (const auto& [detection, edit] : found.deleted) {
    association.detections[detection].fate = BoxFate::kDeleted;
  }
  Clusters clusters = ClusterDetections(model, pairs, kept, threads);
  association.is_settled = clusters.is_settled;
  clusters.all = WithEdits(model, found, std::move(clusters.all));
  association.tracks.resize(clusters.all.size());
  ParallelFor(clusters.all.size(), threads, [&](size_t i) {
    association.tracks[i] = Finished(model, clusters.all[i], &association.detections);
  });
  std::ranges::stable_sort(association.tracks, {},
                           [](const Track& track) { return track.detections.front(); });
  DropFalseTracks(model, threads, &association);
  const auto tracks = static_cast<int>(association.tracks.size());
  for (int i = 0; i < tracks; ++i) {
    const Track& track = association.tracks[i];
    for (const int box : track.boxes) association.detections[box].track = i;
    if (track.fate != TrackFate::kObject) continue;
    const auto object = static_cast<int>(association.objects.size());
    for (const int used : track.detections) association.detections[used].object = object;
    association.objects.push_back(i);
  }
  association.moved_things = FindMovedThings(model, association);
  association.up_of_segments = model.up_of_segments();
  AddDecisiveEvidence(model, pairs, threads, &association);
  return association;
}

const std::string& LabelOf(const Track& track) {
  const auto voted_for = std::ranges::find_if(
      track.labels, [&](const auto& label) { return track.votes.contains(label.label); });
  return voted_for == track.labels.end() ? track.labels.front().label : voted_for->label;
}

}  // namespace soslam
