// SPDX-License-Identifier: BSD-3-Clause
#include "association/association.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>

#include "association/link_frames.h"
#include "association/merge_tracks.h"

namespace soslam {
namespace {

// Fills Association::objects, ordered by the first detection in the sequence.
void ListObjects(const Sequence& sequence, Association* association) {
  for (int i = 0; i < static_cast<int>(association->tracks.size()); ++i) {
    if (association->tracks[static_cast<size_t>(i)].fate == TrackFate::kObject) {
      association->objects.push_back(i);
    }
  }
  const auto first_frame = [&](int track) {
    const int detection = association->tracks[static_cast<size_t>(track)].detections.front();
    return sequence.detections[static_cast<size_t>(detection)].frame_index;
  };
  std::ranges::stable_sort(association->objects, {}, first_frame);
  for (size_t object = 0; object < association->objects.size(); ++object) {
    const auto track = static_cast<size_t>(association->objects[object]);
    for (const int detection : association->tracks[track].detections) {
      association->detections[static_cast<size_t>(detection)].object = static_cast<int>(object);
    }
  }
}

}  // namespace

Sequence WithoutPlanes(Sequence sequence) {
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const AssociateOptions& options, int threads) {
  const AssociationModel model(sequence, table, options);
  Association association = LinkFrames(model, threads);
  MergeTracks(model, threads, &association);
  DropFalseTracks(model, threads, &association);
  ListObjects(sequence, &association);
  association.up_of_segments = model.up_of_segments();
  return association;
}

namespace {

std::set<std::string> LabelsOf(const Sequence& sequence) {
  std::set<std::string> labels;
  for (const Object& object : sequence.objects) labels.insert(object.label);
  return labels;
}

}  // namespace

AssociationModel::AssociationModel(const Sequence& sequence, const SemanticTable& table,
                                   const AssociateOptions& options)
    : sequence_(sequence),
      table_(table),
      options_(options),
      up_of_segments_(sequence.planes.empty() ? UpOfSegments(sequence, table, options)
                                              : std::map<int, UpEstimate>()),
      boxes_(sequence, options),
      labels_(LabelsOf(sequence), options.label_confusion, options.interchangeable_labels) {}

void AssociationModel::Fit(Track* track) const {
  ShapePrior prior = PriorOfLabel(table_, WinningLabel(track->votes), options_);
  if (track->plane_index != kNoPlane) prior = TurnedToSupport(prior);
  const auto up = up_of_segments_.find(SegmentOf(*track));
  const auto fit =
      FitObject(sequence_, track->detections, prior, options_,
                up == up_of_segments_.end() ? std::nullopt : std::optional(up->second));
  if (fit) track->fit = fit;
}

int AssociationModel::SegmentOf(const Track& track) const {
  const auto first = static_cast<size_t>(track.detections.front());
  return sequence_.FrameOf(sequence_.detections[first]).segment;
}

std::optional<Prediction> AssociationModel::Predict(const Track& track, int frame_index) const {
  if (!track.fit ||
      SegmentOf(track) != sequence_.frames[static_cast<size_t>(frame_index)].segment) {
    return std::nullopt;
  }
  const auto frame_of = [this](int detection) {
    return sequence_.detections[static_cast<size_t>(detection)].frame_index;
  };
  const auto next =
      std::lower_bound(track.detections.begin(), track.detections.end(), frame_index,
                       [&](int detection, int frame) { return frame_of(detection) < frame; });
  int nearest =
      next == track.detections.end() ? frame_of(track.detections.back()) : frame_of(*next);
  if (next != track.detections.begin()) {
    const int before = frame_of(*std::prev(next));
    if (std::abs(frame_index - before) <= std::abs(frame_index - nearest)) nearest = before;
  }
  return boxes_.Predict(*track.fit, nearest, frame_index);
}

std::optional<BoxMatch> AssociationModel::Match(const Track& track, const Prediction& prediction,
                                                const Detection& detection) const {
  if (PlaneOf(detection) != track.plane_index) return std::nullopt;
  const double label_cost = labels_.Cost(WinningLabel(track.votes), LabelOf(detection));
  if (!std::isfinite(label_cost)) return std::nullopt;
  auto match = boxes_.Match(prediction, detection);
  if (!match) return std::nullopt;
  match->cost += label_cost - 2.0 * std::log(1.0 - options_.new_object_probability);
  return match->cost < NewObjectCost(detection) ? match : std::nullopt;
}

double AssociationModel::NewObjectCost(const Detection& detection) const {
  return boxes_.CostOfAnyBox(detection) + labels_.CostOfAnyLabel() -
         2.0 * std::log(options_.new_object_probability);
}

namespace {

struct Pair {
  int object;
  int given;
  int shared;  // detections
};

// All pairs that share detections, those with the most first.
std::vector<Pair> PairsByShare(const Sequence& sequence, const Association& association) {
  std::map<std::pair<int, int>, int> shared;
  for (size_t i = 0; i < association.detections.size(); ++i) {
    const int object = association.detections[i].object;
    if (object >= 0) ++shared[{object, sequence.detections[i].object_index}];
  }
  std::vector<Pair> pairs;
  for (const auto& [pair, count] : shared) pairs.push_back({pair.first, pair.second, count});
  std::ranges::stable_sort(pairs, std::ranges::greater(), &Pair::shared);
  return pairs;
}

const char* ReasonNotUsed(const Association& association, const DetectionDecision& decision) {
  if (decision.decision == LinkDecision::kDuplicate || decision.superseded) {
    return "duplicate_of_another_box";
  }
  int track = decision.track;
  while (association.tracks[static_cast<size_t>(track)].fate == TrackFate::kMerged) {
    track = association.tracks[static_cast<size_t>(track)].merged_into;
  }
  return kTrackFateNames[static_cast<size_t>(association.tracks[static_cast<size_t>(track)].fate)];
}

}  // namespace

std::optional<double> Agreement::Precision() const {
  if (given_objects == 0) return std::nullopt;
  if (given_of_object.empty()) return 0.0;
  return static_cast<double>(matched) / static_cast<double>(given_of_object.size());
}

std::optional<double> Agreement::Recall() const {
  if (given_objects == 0) return std::nullopt;
  return static_cast<double>(matched) / given_objects;
}

std::optional<double> Agreement::F1() const {
  if (given_objects == 0) return std::nullopt;
  return 2.0 * matched / static_cast<double>(given_objects + given_of_object.size());
}

Agreement CompareWithGiven(const Sequence& sequence, const Association& association,
                           int min_observations) {
  const auto given = DetectionsByObject(sequence);
  Agreement agreement;
  agreement.given_of_object.resize(association.objects.size());
  const auto counts = [&](size_t i) {
    return sequence.objects[i].is_static && static_cast<int>(given[i].size()) >= min_observations;
  };
  for (size_t i = 0; i < given.size(); ++i) agreement.given_objects += counts(i) ? 1 : 0;
  std::set<int> taken;
  for (const Pair& pair : PairsByShare(sequence, association)) {
    auto& given_of_object = agreement.given_of_object[static_cast<size_t>(pair.object)];
    if (given_of_object || !taken.insert(pair.given).second) continue;
    given_of_object = pair.given;
    const auto track = static_cast<size_t>(association.objects[static_cast<size_t>(pair.object)]);
    const auto estimated_size = static_cast<int>(association.tracks[track].detections.size());
    const auto given_size = static_cast<int>(given[static_cast<size_t>(pair.given)].size());
    if (counts(static_cast<size_t>(pair.given)) &&
        2 * pair.shared > estimated_size + given_size - pair.shared)
      ++agreement.matched;
  }
  return agreement;
}

Sequence AssociatedSequence(const Sequence& sequence, const Association& association,
                            const Agreement& agreement) {
  Sequence associated = sequence;
  associated.objects.clear();
  associated.detections.clear();
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const Track& track = association.tracks[static_cast<size_t>(association.objects[i])];
    Object object{static_cast<int>(i) + 1, WinningLabel(track.votes), track.plane_index, {}};
    if (const auto given = agreement.given_of_object[i]) {
      const Object& given_object = sequence.objects[static_cast<size_t>(*given)];
      if (given_object.is_static) object.ground_truth = given_object.ground_truth;
    }
    associated.objects.push_back(object);
  }
  for (size_t i = 0; i < association.detections.size(); ++i) {
    const DetectionDecision& decision = association.detections[i];
    if (decision.object >= 0) {
      associated.detections.push_back(sequence.detections[i]);
      associated.detections.back().object_index = decision.object;
    } else {
      const char* reason = ReasonNotUsed(association, decision);
      ++associated.rejected_detections[reason];
      associated.rejected.push_back(
          Rejected(sequence, sequence.detections[i], RejectingStage::kAssociate, reason));
    }
  }
  std::ranges::stable_sort(associated.detections, {}, [](const Detection& detection) {
    return std::tuple(detection.frame_index, detection.object_index);
  });
  return associated;
}

}  // namespace soslam
