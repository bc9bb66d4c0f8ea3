// SPDX-License-Identifier: BSD-3-Clause
#include "association/agreement.h"

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
  while (association.tracks[track].fate == TrackFate::kMerged) {
    track = association.tracks[track].merge.into;
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
    auto& given_of_object = agreement.given_of_object[pair.object];
    if (given_of_object || !taken.insert(pair.given).second) continue;
    given_of_object = pair.given;
    const auto track = static_cast<size_t>(association.objects[static_cast<size_t>(pair.object)]);
    const auto estimated_size = static_cast<int>(association.tracks[track].detections.size());
    const auto given_size = static_cast<int>(given[pair.given].size());
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
    const Track& track = association.tracks[association.objects[i]];
    Object object{static_cast<int>(i) + 1, LabelOf(track), track.plane_index, {}};
    object.labels = track.labels;
    std::erase_if(object.labels, [](const LabelProbability& label) {
      return label.probability < kNegligibleProbability;
    });
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

}  // namespace soslam
