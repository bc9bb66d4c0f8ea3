// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/result_checks.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/options.h"
#include "soslam/initialisation/points_in_frames.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/reasons.h"
#include "soslam/orientation/cuboids.h"
#include "soslam/orientation/options.h"
#include "soslam/orientation/refine_by_profile.h"
#include "soslam/orientation/refine_by_turning.h"
#include "soslam/orientation/texture_asymmetry.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

// Throws SettingsError if points are to be used with another method than `needed`, or without file.
void CheckPointEvidence(const PointOptions& options, std::string_view method,
                        std::string_view needed, const StageFiles& files) {
  if (options.point_evidence && method != needed) {
    throw SettingsError(
        fmt::format("point_evidence = true needs method = {}; found {}", needed, method));
  }
  CheckHasPoints(options, files);
}

// Empty unless points are evidence.
std::optional<PointsInFrames> ReadPointsInFrames(const PointOptions& options,
                                                 const Sequence& sequence,
                                                 const StageFiles& files) {
  if (!options.point_evidence) return std::nullopt;
  return PointsInFrames(sequence, WithoutDistortion(sequence, ReadCheckedPoints(sequence, files)),
                        options);
}

// How many observations have points, for the last line of a stage; empty if points are not used.
std::string CountWithPoints(const std::optional<PointsInFrames>& points,
                            const LandmarkEstimates& estimates) {
  if (!points) return "";
  const auto count =
      std::ranges::count_if(estimates.observations, [&](const ObservationEstimate& observation) {
        return points->Of(observation.detection_index, observation.hypotheses).has_value();
      });
  return fmt::format("; points in {} of {} observations", count, estimates.observations.size());
}

// The estimates of the method that the options name.
LandmarkEstimates Initialise(const Sequence& sequence, const SemanticTable& table,
                             const std::optional<PointsInFrames>& points,
                             const InitialiseOptions& options, const StageFiles& files,
                             int threads) {
  if (options.method == InitialisationMethod::kSvd) return InitialiseSvd(sequence);
  if (options.method == InitialisationMethod::kCuboidProposals) {
    return InitialiseCuboids(sequence, EdgesOfSequence(sequence, files), options.cuboids, threads);
  }
  if (options.method == InitialisationMethod::kSingleFrame) {
    return InitialiseSingleFrame(sequence, ObjectRatios(sequence, table, options.ratio_prior),
                                 options.single_frame, threads);
  }
  const auto priors = ObjectPriors(sequence, table, options.ratio_prior, options.shape);
  if (options.method == InitialisationMethod::kMultiView) {
    return InitialiseMultiView(sequence, priors, options.upright, threads);
  }
  return InitialiseUpright(sequence, priors, options.upright, threads,
                           YawPriors(sequence, priors, options.yaw_prior, options.upright, threads),
                           points ? &*points : nullptr);
}

}  // namespace

void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads) {
  const bool uses_images = options.method == InitialisationMethod::kCuboidProposals;
  if (uses_images && !files.contains("edges")) {
    throw SettingsError("method = cuboid_proposals needs --edges FILE; found none");
  }
  CheckPointEvidence(options.points,
                     kInitialisationMethodNames[static_cast<size_t>(options.method)], "yaw_sweep",
                     files);
  Sequence sequence = ReadSequence(files.at("sequence"));
  std::vector<std::filesystem::path> inputs = {files.at("sequence"), files.at("table")};
  AddPictureEvidence(options.pictures, files, &sequence, &inputs);
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  std::vector<Finding> of_labels;
  const bool has_ratios = options.method != InitialisationMethod::kSvd &&
                          options.method != InitialisationMethod::kCuboidProposals;
  if (has_ratios && options.ratio_prior == RatioPrior::kTable) {
    of_labels = CheckLabels(sequence, table, files.at("table").filename().string());
    ReportFindings("initialise", of_labels);
    const auto labels = LabelsWithoutEntry(sequence, table);
    if (of_labels.empty() && !labels.empty()) {  // few labels are no finding
      fmt::print(stderr, "soslam-initialise: not in {}: {}; {}\n", files.at("table").string(),
                 fmt::join(labels, ", "),
                 table.default_prior ? "its default is used" : "their objects are left out");
    }
  }
  const auto points = ReadPointsInFrames(options.points, sequence, files);
  const LandmarkEstimates estimates = Initialise(sequence, table, points, options, files, threads);
  const auto failures = CountFailures(estimates);
  int failed = 0;
  for (const auto& [reason, count] : failures) failed += count;
  const auto tried = static_cast<int>(estimates.observations.size() + estimates.objects.size());
  if (failed == tried) {
    throw NothingUsableError(fmt::format("{}: no landmark from {} tries: {}",
                                         files.at("sequence").string(), tried,
                                         CountsInWords(ReasonsInWords(failures))));
  }
  std::vector<Finding> findings = CheckObjectIds(sequence);
  std::ranges::move(CheckFailures(estimates), std::back_inserter(findings));
  std::ranges::move(options.method == InitialisationMethod::kSvd
                        ? CheckDegenerate(estimates)
                        : CheckSizes(estimates, sequence, table),
                    std::back_inserter(findings));
  std::ranges::move(CheckCollapsed(estimates), std::back_inserter(findings));
  ReportFindings("initialise", findings);
  std::ranges::move(of_labels, std::back_inserter(findings));
  if (uses_images) inputs.push_back(files.at("edges"));
  if (options.points.point_evidence) inputs.push_back(files.at("points"));
  WriteLandmarks(files.at("output"), estimates, sequence,
                 {OptionsToJson(options), inputs, findings, "initialise"});
  fmt::print("{} landmarks{}{}{}\n", tried - failed, failed > 0 ? ", without one: " : "",
             failed > 0 ? CountsInWords(ReasonsInWords(failures)) : "",
             CountWithPoints(points, estimates));
}

namespace {

// Edge maps of a frame, loaded for its first observation and released after its last.
class FrameInUse {
 public:
  void Expect() { ++to_come_; }
  std::shared_ptr<const FrameEdges> Take(const EdgeSource& edges_of, const Frame& frame) {
    const std::lock_guard lock(mutex_);
    if (!edges_) edges_ = std::make_shared<const FrameEdges>(edges_of(frame));
    return --to_come_ > 0 ? edges_ : std::move(edges_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const FrameEdges> edges_;
  size_t to_come_ = 0;
};

// Refines frame by frame, so that few edge maps are in memory at a time.
std::vector<RefinedObservation> RefineAll(const Sequence& sequence,
                                          const std::vector<ObservationEstimate*>& initial,
                                          const std::vector<std::optional<ShapePrior>>& priors,
                                          const std::optional<PointsInFrames>& points,
                                          const OrientationOptions& options,
                                          const EdgeSource& edges_of, int threads) {
  const auto detection_of = [&](size_t i) -> const Detection& {
    return sequence.detections[initial[i]->detection_index];
  };
  std::map<int, FrameInUse> frames;  // keyed by index
  for (size_t i = 0; i < initial.size(); ++i) frames[detection_of(i).frame_index].Expect();
  std::vector<RefinedObservation> refined(initial.size());
  ParallelFor("landmarks", initial.size(), threads, [&](size_t i) {
    const Detection& detection = detection_of(i);
    const auto edges = frames.at(detection.frame_index).Take(edges_of, sequence.FrameOf(detection));
    const auto& prior = priors[detection.object_index];
    if (options.method == RefinementMethod::kProfile) {
      const int detection_index = initial[i]->detection_index;
      refined[i] = RefineByProfile(
          sequence, detection_index, edges, prior, options.profile, options.turn.symmetry,
          points ? points->Of(detection_index, initial[i]->hypotheses) : std::nullopt);
    } else {
      const auto ratio = prior ? std::optional(prior->ratio) : std::nullopt;
      refined[i] = RefineByTurning(sequence, *initial[i], edges->maps, ratio, options.turn);
    }
  });
  return refined;
}

}  // namespace

void RunRefine(const OrientationOptions& options, const StageFiles& files, int threads) {
  if (options.method == RefinementMethod::kProfile && options.profile.texture_symmetry) {
    CheckMirrorPlane(options.profile.texture, options.turn.symmetry.descriptor);
  }
  const PointOptions& point_options = options.profile.points;
  CheckPointEvidence(point_options, kRefinementMethodNames[static_cast<size_t>(options.method)],
                     "profile", files);
  CheckWasMadeOf(files.at("initial"), "landmarks", files.at("sequence"));
  Sequence sequence = ReadSequence(files.at("sequence"));
  std::vector<std::filesystem::path> inputs = {files.at("sequence"), files.at("table"),
                                               files.at("initial"), files.at("edges")};
  AddPictureEvidence(options.profile.pictures, files, &sequence, &inputs);
  const auto priors = ObjectPriors(sequence, ReadSemanticTable(files.at("table")),
                                   options.turn.ratio_prior, options.profile.shape);
  LandmarkEstimates estimates = ReadLandmarks(files.at("initial"), sequence);
  const auto frame_of = [&](const ObservationEstimate* observation) -> const Frame& {
    return sequence.FrameOf(sequence.detections[observation->detection_index]);
  };
  std::vector<ObservationEstimate*> to_refine;
  size_t without_image = 0, failed = 0;
  for (ObservationEstimate& observation : estimates.observations) {
    if (observation.hypotheses.empty()) continue;
    if (frame_of(&observation).image.empty()) {
      observation.failure = "frame_without_image";
      ++without_image;
    } else {
      to_refine.push_back(&observation);
    }
  }
  if (to_refine.empty()) {
    throw NothingUsableError(files.at("initial").string() +
                             ": no single-frame landmark to refine in a frame that has an image");
  }
  std::ranges::stable_sort(to_refine, {},
                           [&](const auto* observation) { return frame_of(observation).id; });
  ArtefactInfo info = {.settings = OptionsToJson(options), .inputs = inputs, .stage = "refine"};
  if (point_options.point_evidence) info.inputs.push_back(files.at("points"));

  const auto points = ReadPointsInFrames(point_options, sequence, files);
  auto refined = RefineAll(sequence, to_refine, priors, points, options,
                           EdgesOfSequence(sequence, files), threads);
  std::vector<SymmetryRecord> curves;
  for (size_t i = 0; i < refined.size(); ++i) {
    failed += refined[i].estimate.failure.empty() ? 0 : 1;
    curves.push_back(std::move(refined[i].record));
    *to_refine[i] = std::move(refined[i].estimate);
  }
  WriteSymmetry(files.at("curves"), curves, info);
  WriteLandmarks(files.at("output"), estimates, sequence, info);
  fmt::print("{} landmarks refined, {} left as they were{}\n", curves.size() - failed,
             failed + without_image, CountWithPoints(points, estimates));
}

}  // namespace soslam
