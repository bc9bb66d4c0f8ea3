// SPDX-License-Identifier: BSD-3-Clause
#include "stage/landmark_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "artefact/hdf5_artefact.h"
#include "artefact/landmarks_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "evaluation/result_checks.h"
#include "geometry/angles.h"
#include "initialisation/initialise.h"
#include "orientation/refine_orientation.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

std::vector<std::optional<YawPrior>> YawPriorsOf(
    const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& shapes,
    const InitialiseOptions& options, int threads) {
  const StandingOptions standing = {options.upright.detection_sigma_fraction,
                                    options.view_correlation_deg * kRadPerDeg,
                                    options.upright.yaw_grid_deg * kRadPerDeg};
  return YawPriors(sequence, shapes, options.yaw_prior, standing, threads);
}

}  // namespace

void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads) {
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  LandmarkEstimates estimates;
  if (options.method == InitialisationMethod::kSvd) {
    estimates = InitialiseSvd(sequence);
  } else {
    if (options.ratio_prior == RatioPrior::kTable) {
      const auto labels = LabelsWithoutEntry(sequence, table);
      if (!labels.empty()) {
        fmt::print(stderr, "soslam-initialise: not in {}: {}; {}\n", files.at("table").string(),
                   fmt::join(labels, ", "),
                   table.default_prior ? "its default is used" : "their objects are left out");
      }
    }
    const auto priors = ObjectPriors(sequence, table, options.ratio_prior, options.shape);
    if (options.method == InitialisationMethod::kMultiView) {
      estimates = InitialiseMultiView(sequence, priors, options, threads);
    } else if (options.method == InitialisationMethod::kYawSweep) {
      estimates = InitialiseUpright(sequence, priors, options.upright, threads,
                                    YawPriorsOf(sequence, priors, options, threads));
    } else {
      estimates = InitialiseSingleFrame(
          sequence, ObjectRatios(sequence, table, options.ratio_prior), options, threads);
    }
  }

  const auto failures = CountFailures(estimates);
  int failed = 0;
  for (const auto& [reason, count] : failures) failed += count;
  const auto tried = static_cast<int>(estimates.observations.size() + estimates.objects.size());
  if (failed == tried) {
    throw NothingUsableError(fmt::format("{}: no landmark from {} tries: {}",
                                         files.at("sequence").string(), tried,
                                         CountsText(failures)));
  }
  std::vector<Finding> findings = CheckFailures(estimates);
  std::ranges::move(options.method == InitialisationMethod::kSvd
                        ? CheckDegenerate(estimates)
                        : CheckSizes(estimates, sequence, table),
                    std::back_inserter(findings));
  std::ranges::move(CheckCollapsed(estimates), std::back_inserter(findings));
  ReportFindings("initialise", findings);
  WriteLandmarks(files.at("output"), estimates, sequence,
                 {OptionsToJson(options), {files.at("sequence"), files.at("table")}, findings});
  fmt::print("{} landmarks{}{}\n", tried - failed, failed > 0 ? ", without one: " : "",
             CountsText(failures));
}

namespace {

using ObservationsOfFrame = std::vector<const ObservationEstimate*>;

// Observations per frame, without frames that have no image.
std::vector<ObservationsOfFrame> GroupByFrame(const Sequence& sequence,
                                              const LandmarkEstimates& initial) {
  std::vector<ObservationsOfFrame> groups(sequence.frames.size());
  for (const ObservationEstimate& observation : initial.observations) {
    if (observation.hypotheses.empty()) continue;
    const auto& detection = sequence.detections[static_cast<size_t>(observation.detection_index)];
    if (sequence.FrameOf(detection).image.empty()) continue;
    groups[static_cast<size_t>(detection.frame_index)].push_back(&observation);
  }
  return groups;
}

// Edge maps of a frame, loaded for its first observation and released after its last.
class FrameInUse {
 public:
  explicit FrameInUse(size_t observations) : to_come_(observations) {}
  std::shared_ptr<const FrameEdges> Take(const EdgesReader& reader, int frame_id) {
    const std::lock_guard lock(mutex_);
    if (!edges_) edges_ = std::make_shared<const FrameEdges>(reader.Read(frame_id));
    return --to_come_ > 0 ? edges_ : std::move(edges_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const FrameEdges> edges_;
  size_t to_come_;
};

class Refiner {
 public:
  Refiner(const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& priors,
          const OrientationOptions& options)
      : sequence_(sequence), priors_(priors), options_(options) {}

  // Refines frame by frame, so that few edge maps are in memory at a time.
  std::vector<RefinedObservation> Refine(const std::vector<ObservationsOfFrame>& groups,
                                         const EdgesReader& reader, int threads) const {
    std::deque<FrameInUse> frames;
    std::vector<std::pair<const ObservationEstimate*, FrameInUse*>> tasks;
    for (const ObservationsOfFrame& observations : groups) {
      if (observations.empty()) continue;
      FrameInUse& frame = frames.emplace_back(observations.size());
      for (const ObservationEstimate* observation : observations) {
        tasks.emplace_back(observation, &frame);
      }
    }
    std::vector<RefinedObservation> refined(tasks.size());
    ParallelFor("landmarks", static_cast<int>(tasks.size()), threads, [&](int i) {
      const auto& [observation, frame] = tasks[static_cast<size_t>(i)];
      const auto& detection =
          sequence_.detections[static_cast<size_t>(observation->detection_index)];
      const auto edges = frame->Take(reader, sequence_.FrameOf(detection).id);
      const auto& prior = priors_[static_cast<size_t>(detection.object_index)];
      refined[static_cast<size_t>(i)] = Refine(*observation, edges, prior);
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
  if (std::ranges::all_of(groups, &ObservationsOfFrame::empty)) {
    throw NothingUsableError(files.at("initial").string() +
                             ": no single-frame landmark to refine in a frame that has an image");
  }
  const ArtefactInfo info = {
      OptionsToJson(options),
      {files.at("sequence"), files.at("table"), files.at("initial"), files.at("edges")}};

  const EdgesReader reader(files.at("edges"));
  const Refiner refiner(sequence, priors, options);
  std::vector<SymmetryRecord> curves;
  int refined_count = 0;
  std::map<int, ObservationEstimate> refined_by_detection;
  for (RefinedObservation& refined : refiner.Refine(groups, reader, threads)) {
    if (refined.estimate.failure.empty()) ++refined_count;
    curves.push_back(std::move(refined.record));
    refined_by_detection[refined.estimate.detection_index] = std::move(refined.estimate);
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
