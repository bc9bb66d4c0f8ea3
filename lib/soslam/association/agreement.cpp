// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/agreement.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace soslam {
namespace {

// Labels that are less probable are not kept.
constexpr double kNegligibleProbability = 0.01;

const char* ReasonNotUsed(const Association& association, const DetectionDecision& decision) {
  if (decision.fate == BoxFate::kDuplicate) return "duplicate_of_another_box";
  if (decision.fate == BoxFate::kDeleted) return NameOf(decision.fate);
  const TrackFate fate = association.tracks[decision.track].fate;
  if (fate != TrackFate::kObject) return NameOf(fate);
  return decision.fate == BoxFate::kSecond ? "duplicate_of_another_box" : "not_explained";
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
  std::map<std::pair<int, int>, int> shared;  // number of detections, by object and given object
  for (size_t i = 0; i < association.detections.size(); ++i) {
    const int object = association.detections[i].object;
    if (object >= 0) ++shared[{object, sequence.detections[i].object_index}];
  }
  // Pairs that share the most come first.
  std::vector<std::pair<std::pair<int, int>, int>> pairs(shared.begin(), shared.end());
  std::ranges::stable_sort(pairs, std::ranges::greater(),
                           &std::pair<std::pair<int, int>, int>::second);
  std::set<int> taken;
  for (const auto& [pair, shared_detections] : pairs) {
    const auto [object_index, given_index] = pair;
    auto& given_of_object = agreement.given_of_object[object_index];
    if (given_of_object || !taken.insert(given_index).second) continue;
    given_of_object = given_index;
    const auto track = static_cast<size_t>(association.objects[static_cast<size_t>(object_index)]);
    const auto estimated_size = static_cast<int>(association.tracks[track].detections.size());
    const auto given_size = static_cast<int>(given[given_index].size());
    if (counts(static_cast<size_t>(given_index)) &&
        2 * shared_detections > estimated_size + given_size - shared_detections) {
      ++agreement.matched;
    }
  }
  return agreement;
}

Sequence AssociatedSequence(const Sequence& sequence, const Association& association,
                            const Agreement& agreement) {
  Sequence associated = sequence;
  associated.objects.clear();
  associated.detections.clear();
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const Track& track = association.tracks[association.objects[i]];
    Object object{static_cast<int>(i) + 1, LabelOf(track), track.plane_index, {}};
    object.labels = track.labels;
    std::erase_if(object.labels, [](const LabelProbability& label) {
      return label.probability < kNegligibleProbability;
    });
    if (track.by_hand) object.known_size = track.by_hand->size;
    if (const auto given = agreement.given_of_object[i]) {
      const Object& given_object = sequence.objects[*given];
      if (given_object.is_static) object.ground_truth = given_object.ground_truth;
    }
    associated.objects.push_back(object);
  }
  for (size_t i = 0; i < association.detections.size(); ++i) {
    const DetectionDecision& decision = association.detections[i];
    if (decision.object >= 0) {
      Detection detection = sequence.detections[i];
      detection.object_index = decision.object;
      if (decision.match && decision.match->cut_edge == BoxSide::kBottom &&
          association.tracks[decision.track].fit->feet_are_hidden) {
        detection.is_one_sided[static_cast<size_t>(BoxSide::kBottom)] = true;
      }
      const int plane = associated.ObjectOf(detection).plane_index;
      if (plane != kNoPlane && !sequence.HasSupports()) {
        detection.plane_in_camera =
            Transform(sequence.FrameOf(detection).world_from_camera.Inverse(),
                      sequence.planes[plane].plane_in_world);
      }
      associated.detections.push_back(std::move(detection));
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

Associations::DetectionName NameOfDetection(const Sequence& sequence, int detection) {
  const Detection& named = sequence.detections[detection];
  return {sequence.FrameOf(named).id, sequence.ObjectOf(named).id, named.box};
}

Associations MakeReport(const Sequence& sequence, const Association& association,
                        const Agreement& agreement) {
  const auto if_any = [](int index, int first_id) {
    return index >= 0 ? std::optional(index + first_id) : std::nullopt;
  };
  Associations report;
  for (size_t i = 0; i < association.detections.size(); ++i) {
    const DetectionDecision& decision = association.detections[i];
    Associations::DetectionRow row = {NameOfDetection(sequence, static_cast<int>(i)),
                                      sequence.ObjectOf(sequence.detections[i]).label,
                                      decision.fate};
    if (decision.match) {
      row.match = {decision.match->overlap, decision.match->distance, decision.match->cut_edge};
    }
    row.track = if_any(decision.track, 0);
    row.object = if_any(decision.object, 1);
    if (decision.duplicate_of >= 0) {
      row.duplicate_of = NameOfDetection(sequence, decision.duplicate_of);
    }
    report.detections.push_back(row);
  }
  for (const Track& track : association.tracks) {
    Associations::TrackRow row = {static_cast<int>(report.tracks.size()), track.fate};
    row.boxes = static_cast<int>(track.boxes.size());
    row.feet_are_hidden = track.fit && track.fit->feet_are_hidden;
    row.detections = static_cast<int>(track.detections.size());
    row.frames_in_sight = track.frames_in_sight;
    row.overlap_by_boxes = track.overlap_by_boxes;
    report.tracks.push_back(row);
  }
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const Track& track = association.tracks[association.objects[i]];
    const auto given = agreement.given_of_object[i];
    report.objects.push_back({static_cast<int>(i) + 1, association.objects[i], LabelOf(track),
                              track.votes, static_cast<int>(track.detections.size()),
                              given ? std::optional(sequence.objects[*given].id) : std::nullopt});
  }
  report.held_least = association.held_least;
  report.held_most = association.held_most;
  report.kept_out = association.kept_out;
  report.agreement = {static_cast<int>(agreement.given_of_object.size()),
                      agreement.given_objects,
                      agreement.matched,
                      agreement.Precision(),
                      agreement.Recall(),
                      agreement.F1()};
  return report;
}

}  // namespace soslam
