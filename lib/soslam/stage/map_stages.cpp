// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/artefact/run_file.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/evaluation/result_checks.h"
#include "soslam/geometry/angles.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/mapping/back_end.h"
#include "soslam/mapping/check_minima.h"
#include "soslam/mapping/fronts.h"
#include "soslam/mapping/initial_landmarks.h"
#include "soslam/mapping/options.h"
#include "soslam/mapping/quarter_turns.h"
#include "soslam/model/occlusion.h"
#include "soslam/orientation/image_evidence.h"
#include "soslam/orientation/texture_asymmetry.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

bool UsesEdges(const OptimiseOptions& options) {
  return options.symmetry || options.edge_alignment;
}

void CheckEvidence(const OptimiseOptions& options, const StageFiles& files) {
  const bool is_quadric = options.detection_model == DetectionModel::kQuadric;
  const std::pair<bool, const char*> faults[] = {
      {UsesEdges(options) && !files.contains("edges"),
       "symmetry or edge_alignment = true needs --edges FILE; found none"},
      {options.edge_alignment && is_quadric,
       "edge_alignment = true needs detection_model = tangency; found quadric"},
      {options.points.point_evidence && is_quadric,
       "point_evidence = true needs detection_model = tangency; found quadric"}};
  for (const auto& [is_fault, message] : faults) {
    if (is_fault) throw SettingsError(message);
  }
  CheckHasPoints(options.points, files);
  if (options.symmetry) CheckMirrorPlane(options.texture, options.symmetry_options.descriptor);
  const Descriptor descriptor = options.symmetry_options.descriptor;
  if (options.symmetry && !HasDerivative(descriptor)) {
    throw SettingsError(
        fmt::format("symmetry needs a descriptor with a derivative; found descriptor = {}",
                    kDescriptorNames[static_cast<size_t>(descriptor)]));
  }
}

// The back end's input, still without initial landmarks.
BackEndInput ReadInput(const Sequence& sequence, const OptimiseOptions& options,
                       const StageFiles& files, int threads) {
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  BackEndInput input{
      sequence, {}, ObjectPriors(sequence, table, options.ratio_prior, options.shape)};
  if (options.points.point_evidence) {
    input.points = FindObjectPoints(
        sequence, WithoutDistortion(sequence, ReadCheckedPoints(sequence, files)), options.points);
  }
  if (!UsesEdges(options)) return input;
  const auto frame_of = [&](int index) {
    return static_cast<size_t>(sequence.detections[static_cast<size_t>(index)].frame_index);
  };
  std::vector<int> for_symmetry, for_edges;  // indices of detections
  for (std::vector<int>& detections : DetectionsByObject(sequence)) {
    std::erase_if(detections, [&](int index) {
      const Detection& detection = sequence.detections[index];
      return sequence.FrameOf(detection).image.empty() || !sequence.ObjectOf(detection).is_static;
    });
    if (options.symmetry) {
      const auto views = static_cast<size_t>(options.symmetry_views);
      std::ranges::copy(SpreadOver(detections, views), std::back_inserter(for_symmetry));
    }
    if (options.edge_alignment) std::ranges::copy(detections, std::back_inserter(for_edges));
  }
  std::set<size_t> frame_indices;
  for (auto* indices : {&for_symmetry, &for_edges}) {
    std::ranges::sort(*indices);
    for (const int index : *indices) frame_indices.insert(frame_of(index));
  }
  const auto edges_of = EdgesOfSequence(sequence, files);
  const std::vector<size_t> to_read(frame_indices.begin(), frame_indices.end());
  std::vector<std::shared_ptr<const FrameEdges>> frames(sequence.frames.size());
  ParallelFor("edge maps", to_read.size(), threads, [&](size_t i) {
    const size_t frame = to_read[i];
    frames[frame] = std::make_shared<const FrameEdges>(edges_of(sequence.frames[frame]));
  });
  const bool is_quadric = options.detection_model == DetectionModel::kQuadric;
  for (const int index : for_symmetry) {
    const Detection& detection = sequence.detections[index];
    const Camera& camera = sequence.CameraOf(detection);
    auto image =
        std::make_shared<const SymmetryImage>(frames[frame_of(index)]->maps, detection.box);
    input.images.emplace_back(
        index, is_quadric ? MakeSymmetryEvidence(std::move(image), camera, options.symmetry_options,
                                                 options.symmetry_sigma)
                          : MakeAsymmetryEvidence(std::move(image), camera, options.texture,
                                                  options.symmetry_options));
  }
  for (const int index : for_edges) {
    const Detection& detection = sequence.detections[index];
    auto image = std::make_shared<const EdgeImage>(
        EdgeImage{frames[frame_of(index)], detection.box, BoxesInFront(sequence, detection)});
    input.images.emplace_back(
        index, MakeEdgeEvidence(std::move(image), sequence.CameraOf(detection), options.edges));
  }
  return input;
}

// The sequence with the poses and planes of a map.
Sequence AsInMap(Sequence sequence, const MapEstimate& map) {
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    sequence.frames[i].world_from_camera = map.world_from_camera[i];
  }
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    sequence.planes[i].plane_in_world = map.planes_in_world[i];
  }
  return sequence;
}

std::vector<std::optional<Landmark>> CollectLandmarks(const MapEstimate& map,
                                                      const Sequence& sequence) {
  std::vector<std::optional<Landmark>> landmarks(sequence.objects.size());
  for (const ObjectEstimate& object : map.objects) {
    landmarks[static_cast<size_t>(object.object_index)] = object.landmark_in_world;
  }
  return landmarks;
}

}  // namespace

void RunOptimise(const OptimiseOptions& options, const StageFiles& files, int threads) {
  CheckEvidence(options, files);
  CheckWasMadeOf(files.at("landmarks"), "landmarks", files.at("sequence"));
  Sequence sequence = ReadSequence(files.at("sequence"));
  ArtefactInfo info = {.settings = OptionsToJson(options),
                       .inputs = {files.at("sequence"), files.at("landmarks"), files.at("table")},
                       .stage = "optimise"};
  AddPictureEvidence(options.pictures, files, &sequence, &info.inputs);
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  const LandmarkEstimates estimates = ReadLandmarks(files.at("landmarks"), sequence);
  BackEndInput input = ReadInput(sequence, options, files, threads);
  input.initial_landmarks = options.detection_model == DetectionModel::kTangency
                                ? ChooseInitialUprightLandmarks(input, estimates, options, threads)
                                : ChooseInitialLandmarks(sequence, estimates);
  if (std::ranges::none_of(input.initial_landmarks,
                           [](const auto& start) { return start.has_value(); })) {
    throw NothingUsableError(files.at("landmarks").string() + ": no landmark to start from");
  }
  if (UsesEdges(options)) info.inputs.push_back(files.at("edges"));
  if (options.points.point_evidence) info.inputs.push_back(files.at("points"));
  MapEstimate map = OptimiseMap(input, options, threads);
  if (options.detection_model == DetectionModel::kTangency) {
    const Sequence in_map = AsInMap(sequence, map);
    const auto quarter_turns = QuarterTurnProbabilities(
        {in_map, CollectLandmarks(map, sequence), input.priors, input.images, input.points},
        options, map.solver.Dispersion(), threads);
    for (ObjectEstimate& object : map.objects) {
      object.quarter_turn = quarter_turns[static_cast<size_t>(object.object_index)];
    }
    FaceFront(in_map, input.priors, &map);
  }
  const LandmarkEstimates found = {{}, map.objects};
  info.findings = CheckInputs(sequence, map);
  const bool is_explained = !info.findings.empty();
  const auto add = [&](const std::vector<Finding>& findings) {
    std::ranges::copy(findings, std::back_inserter(info.findings));
  };
  add(options.support ? CheckSizes(found, sequence, table) : CheckDegenerate(found));
  add(CheckCollapsed(found));
  // The cost of boxes is a consequence of wrong inputs, and no cause of its own.
  if (options.detection_model == DetectionModel::kTangency && !is_explained) {
    add(CheckCost(map.solver));
  }
  add(CheckPoseCorrections(sequence, map.world_from_camera, options.Odometry()));
  ReportFindings("optimise", info.findings);
  WriteMap(files.at("output"), map, sequence, info);
  // Texture, edges and points are added once boxes and planes have converged.
  const bool has_images = UsesEdges(options) || options.points.point_evidence;
  fmt::print("{} iterations, cost {:.6g}{} -> {:.6g}{}{}\n", map.solver.iterations,
             map.solver.initial_cost, has_images ? " of boxes" : "", map.solver.final_cost,
             has_images ? " with images" : "", map.solver.converged ? "" : ", not converged");
}

int RunCheckMinima(const NoOptions& /*options*/, const StageFiles& files, int threads) {
  const std::filesystem::path path = std::filesystem::weakly_canonical(files.at("map"));
  const RunRecord record = ReadRun(path.parent_path() / "run.json");
  StageFiles inputs;
  for (const RunFile& file : record.inputs) {
    if (!file.argument) continue;
    inputs[*file.argument] =
        (file.relative_to == kRelativeToRun ? path.parent_path() : record.called_in) / file.path;
  }
  OptimiseOptions options;
  for (const auto& [name, setting] : record.settings.value()) {
    OptionsFromJson({{name, setting.value}}, path.string(), &options);
  }
  Sequence imported = ReadSequence(inputs.at("sequence"));
  std::vector<std::filesystem::path> read;
  AddPictureEvidence(options.pictures, inputs, &imported, &read);
  const MapEstimate map = ReadMap(path, imported);
  const Sequence sequence = AsInMap(imported, map);
  BackEndInput input = ReadInput(sequence, options, inputs, threads);
  input.initial_landmarks = CollectLandmarks(map, sequence);
  int above = 0;
  const auto minima = CheckMinima(input, options, threads);
  for (const ObjectMinimum& minimum : minima) {
    if (!minimum.IsAboveLowest()) continue;
    ++above;
    const auto index = static_cast<size_t>(minimum.object_index);
    const Landmark& in_map = *input.initial_landmarks[index];
    fmt::print(
        "object {} ({}): cost {:.3f}, {:.3f} from another start: turned by {:.0f} degrees, "
        "{:.3f} m away, {:.2f} times as large\n",
        sequence.objects[index].id, sequence.objects[index].label, minimum.cost,
        minimum.lowest_cost,
        in_map.frame_from_object.rotation.angularDistance(
            minimum.lowest_in_world.frame_from_object.rotation) /
            kRadPerDeg,
        (minimum.lowest_in_world.Centre() - in_map.Centre()).norm(),
        MeanHalfAxis(minimum.lowest_in_world) / MeanHalfAxis(in_map));
  }
  fmt::print("{} of {} objects have a lower minimum\n", above, minima.size());
  return above > 0 ? kFindings : static_cast<int>(ExitCode::kDone);
}

void RunEvaluate(const EvaluateOptions& options, const StageFiles& files, int /*threads*/) {
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const std::filesystem::path& landmarks = files.at("landmarks");
  const nlohmann::json document = ParseJsonFile(landmarks);
  const nlohmann::json::json_pointer kind("/artefact/kind");
  const bool is_map = document.contains(kind) && document[kind] == "map";
  CheckWasMadeOf(landmarks, is_map ? "map" : "landmarks", files.at("sequence"));
  const Metrics metrics =
      is_map ? EvaluateMap(sequence, ReadMap(landmarks, sequence), options.alignment)
             : EvaluateLandmarks(sequence, ReadLandmarks(landmarks, sequence), options.alignment);
  WriteMetrics(files.at("output"), metrics, sequence,
               {OptionsToJson(options), {files.at("sequence"), landmarks}, {}, "evaluate"});
  if (const auto& held_out = metrics.held_out) {
    fmt::print("held-out frames: {} of {} detections matched, mean IoU {:.3f}\n",
               held_out->detections_matched, held_out->detections,
               held_out->iou_mean.value_or(0.0));
  }
  if (const auto& quality = metrics.map_quality) {
    for (const MapScore& score : quality->scores) {
      fmt::print(
          "IoU of at least {:g}: {} of {} true objects found ({} of the {} detectable), {} of {} "
          "landmarks right, {} ignored; mean IoU of the found {}\n",
          score.min_iou, score.found, score.true_objects, score.found_detectable, score.detectable,
          score.found, score.landmarks - score.ignored, score.ignored,
          score.of_found.iou_mean ? fmt::format("{:.3f}", *score.of_found.iou_mean) : "-");
    }
    ReportFindings("evaluate", quality->alignments.findings);
  }
  if (metrics.summary.objects == 0 && metrics.map_quality) {
    fmt::print("no observed object has ground truth of its own id\n");
  } else if (metrics.summary.objects == 0) {
    fmt::print("no observed object has ground truth: nothing to compare with\n");
  } else {
    fmt::print("{} objects, mean IoU {:.3f}\n", metrics.summary.objects,
               metrics.summary.iou_mean.value_or(0.0));
  }
}

}  // namespace soslam
