// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/inspection/doubts.h"
#include "soslam/model/associations.h"
#include "soslam/model/reasons.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::string MostFrequent(const std::map<std::string, int>& counts) {
  return std::ranges::max_element(counts, {}, [](const auto& pair) { return pair.second; })->first;
}

// A box without a record of the edges that are cut off.
SeenBox BoxInFrame(const Sequence& sequence, int frame_index, const Box& box) {
  const Camera& camera = sequence.CameraOf(sequence.frames[frame_index]);
  constexpr double kMarginPx = 2.0;
  return {frame_index, box, DistanceToBorder(box, camera.width, camera.height) > kMarginPx};
}

}  // namespace

std::vector<SeenBox> CollectBoxes(const Sequence& sequence, const std::vector<int>& detections) {
  std::vector<SeenBox> boxes;
  for (const int index : detections) {
    const Detection& seen = sequence.detections[index];
    boxes.push_back({seen.frame_index, seen.box, std::ranges::count(seen.is_one_sided, true) == 0});
  }
  return boxes;
}

SeenBox FindSeenBox(const Associations::DetectionName& name, const Sequence& sequence) {
  const auto frame = std::ranges::lower_bound(sequence.frames, name.frame, {}, &Frame::id);
  if (frame == sequence.frames.end() || frame->id != name.frame) {
    throw InputError(fmt::format(
        "associations.json: has a detection in frame {}, which sequence.json has not; expected the "
        "two of one run",
        name.frame));
  }
  return BoxInFrame(sequence, static_cast<int>(frame - sequence.frames.begin()), name.box);
}

std::vector<NotPlaced> TracksLeftOut(const Associations& associations, const Sequence& sequence) {
  // The part of each track that is left out, in the order of the list.
  std::map<const Associations::TrackRow*, NotPlaced> left_out;
  std::map<const Associations::TrackRow*, std::map<std::string, int>> labels;
  for (const Associations::DetectionRow& detection : associations.detections) {
    if (!detection.track) continue;  // a second box of something
    const Associations::TrackRow& track = associations.tracks.at(*detection.track);
    if (track.fate == TrackFate::kObject) continue;
    left_out[&track].boxes.push_back(FindSeenBox(detection.name, sequence));
    ++labels[&track][detection.label];
  }
  std::vector<NotPlaced> things;
  for (auto& [track, thing] : left_out) {
    thing.label = MostFrequent(labels[track]);
    thing.reason =
        track->fate == TrackFate::kRarelyDetected
            ? RarelyDetectedInWords(track->detections, track->frames_in_sight.value_or(0))
            : ReasonOf(NameOf(track->fate)).words;
    things.push_back(std::move(thing));
  }
  return things;
}

namespace {

// Why objects have no initial estimate, by their index in the sequence: the reason of the object,
// or the most frequent one of its observations.
std::map<int, std::string> InitialFailures(const fs::path& folder, const Sequence& sequence) {
  std::map<int, std::string> failures;
  const char* file = Exists(folder / "refined.json") ? "refined.json" : "initial.json";
  if (!Exists(folder / file)) return failures;
  const LandmarkEstimates initial = ReadLandmarks(folder / file, sequence);
  std::map<int, std::map<std::string, int>> counts;
  for (const ObservationEstimate& estimate : initial.observations) {
    if (estimate.failure.empty()) continue;
    const Detection& seen = sequence.detections[estimate.detection_index];
    ++counts[seen.object_index][estimate.failure];
  }
  for (const auto& [object, reasons] : counts) failures[object] = MostFrequent(reasons);
  for (const ObjectEstimate& estimate : initial.objects) {
    if (!estimate.failure.empty()) failures[estimate.object_index] = estimate.failure;
  }
  return failures;
}

}  // namespace

std::vector<NotPlaced> CollectUnplaced(const fs::path& folder, const MapEstimate& map,
                                       const Sequence& sequence) {
  constexpr const char* kNoStart = "no_start";  // the stages before know more
  std::map<int, std::string> failures = InitialFailures(folder, sequence);
  std::set<int> placed;
  for (const ObjectEstimate& estimate : map.objects) {
    if (estimate.landmark_in_world) placed.insert(estimate.object_index);
    if (estimate.failure != kNoStart) failures[estimate.object_index] = estimate.failure;
  }
  const auto detections = DetectionsByObject(sequence);
  std::vector<NotPlaced> things;
  for (int i = 0; i < std::ssize(sequence.objects); ++i) {
    if (placed.contains(i) || detections[i].empty()) continue;
    const std::string& failure = failures.try_emplace(i, kNoStart).first->second;
    things.push_back({sequence.objects[i].label, CollectBoxes(sequence, detections[i]),
                      ReasonOf(failure).words});
  }
  std::map<std::string, NotPlaced> left_out_by_planes;  // by label
  for (const RejectedDetection& rejected : sequence.rejected) {
    if (rejected.stage != RejectingStage::kPlanes) continue;
    NotPlaced& thing = left_out_by_planes[rejected.label];
    thing.label = rejected.label;
    thing.reason = ReasonOf(rejected.reason).words;
    thing.boxes.push_back(BoxInFrame(sequence, rejected.frame_index, rejected.box));
  }
  for (auto& [label, thing] : left_out_by_planes) things.push_back(std::move(thing));
  if (Exists(folder / "associations.json")) {
    const Associations associations = ReadAssociations(folder / "associations.json").body;
    std::ranges::move(TracksLeftOut(associations, sequence), std::back_inserter(things));
  }
  std::ranges::stable_sort(things, std::greater<>(),
                           [](const NotPlaced& thing) { return thing.boxes.size(); });
  return things;
}

}  // namespace soslam
