// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "artefact/edges_file.h"
#include "artefact/landmarks_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "artefact/symmetry_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "orientation/refine_orientation.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

constexpr size_t kFramesAtOnce = 8;  // bounds the edge maps held in memory

// Observations by frame: all of one frame share its edge maps. Those of frames without an image are
// left out.
std::vector<std::vector<const ObservationEstimate*>> GroupByFrame(
    const Sequence& sequence, const LandmarkEstimates& initial) {
  std::vector<std::vector<const ObservationEstimate*>> groups(sequence.frames.size());
  for (const ObservationEstimate& observation : initial.observations) {
    if (observation.hypotheses.empty()) continue;
    const auto& detection = sequence.detections[static_cast<size_t>(observation.detection_index)];
    if (sequence.FrameOf(detection).image.empty()) continue;
    groups[static_cast<size_t>(detection.frame_index)].push_back(&observation);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

int CountOf(const std::vector<std::vector<const ObservationEstimate*>>& groups) {
  size_t count = 0;
  for (const auto& group : groups) count += group.size();
  return static_cast<int>(count);
}

class Refiner {
 public:
  Refiner(const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& priors,
          const OrientationOptions& options, int threads, Progress* progress)
      : sequence_(sequence),
        priors_(priors),
        options_(options),
        threads_(threads),
        progress_(progress) {}

  // Refines the observations of some frames in parallel; reading stays on this thread.
  std::vector<RefinedObservation> Refine(
      const std::vector<std::vector<const ObservationEstimate*>>& groups, size_t first, size_t last,
      EdgesReader* edges) const {
    std::vector<std::pair<const ObservationEstimate*, std::shared_ptr<const FrameEdges>>> tasks;
    for (size_t i = first; i < last; ++i) {
      const auto& detection =
          sequence_.detections[static_cast<size_t>(groups[i].front()->detection_index)];
      const int frame_id = sequence_.frames[static_cast<size_t>(detection.frame_index)].id;
      const auto frame = std::make_shared<const FrameEdges>(edges->Read(frame_id));
      for (const ObservationEstimate* observation : groups[i]) {
        tasks.emplace_back(observation, frame);
      }
    }
    std::vector<RefinedObservation> refined(tasks.size());
    ParallelFor(static_cast<int>(tasks.size()), threads_, [&](int i) {
      const auto& [observation, frame] = tasks[static_cast<size_t>(i)];
      const auto& detection =
          sequence_.detections[static_cast<size_t>(observation->detection_index)];
      const auto& prior = priors_[static_cast<size_t>(detection.object_index)];
      refined[static_cast<size_t>(i)] = Refine(*observation, frame, prior);
      progress_->Step();
    });
    return refined;
  }

 private:
  RefinedObservation Refine(const ObservationEstimate& initial,
                            const std::shared_ptr<const FrameEdges>& edges,
                            const std::optional<ShapePrior>& prior) const {
    if (options_.method == RefinementMethod::kProfile) {
      return RefineOrientation(sequence_, initial.detection_index, edges, prior, options_.profile,
                               options_.turn.symmetry);
    }
    const auto ratio = prior ? std::optional(prior->ratio) : std::nullopt;
    return RefineObservation(sequence_, initial, edges->maps, ratio, options_.turn);
  }

  const Sequence& sequence_;
  const std::vector<std::optional<ShapePrior>>& priors_;
  const OrientationOptions& options_;
  int threads_;
  Progress* progress_;
};

}  // namespace

void RunRefine(const OrientationOptions& options, const StageFiles& files, int threads) {
  if (options.turn.parameters == RefinementParameters::kAll &&
      options.turn.symmetry.descriptor == Descriptor::kBrief) {
    throw SettingsError(
        "parameters = all needs a descriptor with a derivative; found descriptor = brief");
  }
  CheckMirrorPlane(options.profile.texture, options.turn.symmetry.descriptor);
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const auto priors = ObjectPriors(sequence, ReadSemanticTable(files.at("table")),
                                   options.turn.ratio_prior, options.profile.shape);
  LandmarkEstimates estimates = ReadLandmarks(files.at("initial"), sequence);
  const auto groups = GroupByFrame(sequence, estimates);
  if (groups.empty()) {
    throw NothingUsableError(files.at("initial").string() +
                             ": no single-frame landmark to refine in a frame that has an image");
  }
  const ArtefactInfo info = {
      OptionsToJson(options),
      {files.at("sequence"), files.at("table"), files.at("initial"), files.at("edges")}};

  EdgesReader edges(files.at("edges"));
  Progress progress("landmarks", CountOf(groups));
  const Refiner refiner(sequence, priors, options, threads, &progress);
  std::vector<SymmetryRecord> curves;
  int refined_count = 0;
  std::map<int, ObservationEstimate> refined_by_detection;
  for (size_t first = 0; first < groups.size(); first += kFramesAtOnce) {
    const size_t last = std::min(groups.size(), first + kFramesAtOnce);
    for (RefinedObservation& refined : refiner.Refine(groups, first, last, &edges)) {
      if (refined.estimate.failure.empty()) ++refined_count;
      curves.push_back(std::move(refined.record));
      refined_by_detection[refined.estimate.detection_index] = std::move(refined.estimate);
    }
  }
  size_t without_image = 0;
  for (ObservationEstimate& observation : estimates.observations) {
    const auto found = refined_by_detection.find(observation.detection_index);
    if (found != refined_by_detection.end()) {
      observation = found->second;
    } else if (!observation.hypotheses.empty()) {
      observation.failure = "frame_without_image";
      ++without_image;
    }
  }
  WriteSymmetry(files.at("curves"), curves, info);
  WriteLandmarks(files.at("output"), estimates, sequence, info);
  fmt::print("{} landmarks refined, {} left as they were\n", refined_count,
             curves.size() - static_cast<size_t>(refined_count) + without_image);
}

}  // namespace soslam
