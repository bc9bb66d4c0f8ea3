// SPDX-License-Identifier: BSD-3-Clause
#include "stage/map_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "artefact/hdf5_artefact.h"
#include "artefact/json_file.h"
#include "artefact/landmarks_file.h"
#include "artefact/metrics_file.h"
#include "artefact/points_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "cli/command_line.h"
#include "evaluation/metrics.h"
#include "evaluation/result_checks.h"
#include "mapping/back_end.h"
#include "mapping/initial_landmarks.h"
#include "model/occlusion.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

void CheckEvidence(const OptimiseOptions& options, const StageFiles& files) {
  if ((options.symmetry || options.edge_alignment) && files.count("edges") == 0) {
    throw SettingsError("symmetry or edge_alignment = true needs --edges FILE; found none");
  }
  if (options.edge_alignment && options.detection_model != DetectionModel::kTangency) {
    throw SettingsError("edge_alignment = true needs detection_model = tangency; found quadric");
  }
  if (options.point_evidence && files.count("points") == 0) {
    throw SettingsError("point_evidence = true needs --points FILE; found none");
  }
  if (options.point_evidence && options.detection_model != DetectionModel::kTangency) {
    throw SettingsError("point_evidence = true needs detection_model = tangency; found quadric");
  }
  if (options.symmetry) CheckMirrorPlane(options.texture, options.symmetry_options.descriptor);
  if (options.symmetry && options.symmetry_options.descriptor == Descriptor::kBrief) {
    throw SettingsError("symmetry needs a descriptor with a derivative; found descriptor = brief");
  }
}

// Observations of static objects, in frames with an image, that are used for texture and for edges.
struct ImageUse {
  std::vector<int> symmetry, edges;  // indices in Sequence::detections
};
ImageUse ChooseImageUse(const Sequence& sequence, const OptimiseOptions& options) {
  ImageUse use;
  for (std::vector<int> detections : DetectionsByObject(sequence)) {
    std::erase_if(detections, [&](int index) {
      const Detection& detection = sequence.detections[static_cast<size_t>(index)];
      return sequence.FrameOf(detection).image.empty() || !sequence.ObjectOf(detection).is_static;
    });
    if (options.symmetry) {
      const auto views = static_cast<size_t>(options.symmetry_views);
      std::ranges::copy(SpreadOver(detections, views), std::back_inserter(use.symmetry));
    }
    if (options.edge_alignment) std::ranges::copy(detections, std::back_inserter(use.edges));
  }
  return use;
}

// Reads the edge maps for symmetry and edge alignment.
void ReadImages(const OptimiseOptions& options, const std::filesystem::path& edges_file,
                int threads, BackEndInput* input) {
  const Sequence& sequence = input->sequence;
  const ImageUse use = ChooseImageUse(sequence, options);
  const auto detection_at = [&](int index) -> const Detection& {
    return sequence.detections[static_cast<size_t>(index)];
  };
  std::set<int> frame_indices;
  for (const auto* indices : {&use.symmetry, &use.edges}) {
    for (const int index : *indices) frame_indices.insert(detection_at(index).frame_index);
  }
  const EdgesReader reader(edges_file);
  const std::vector<int> to_read(frame_indices.begin(), frame_indices.end());
  std::vector<std::shared_ptr<const FrameEdges>> frames(sequence.frames.size());
  ParallelFor("edge maps", static_cast<int>(to_read.size()), threads, [&](int i) {
    const auto frame = static_cast<size_t>(to_read[static_cast<size_t>(i)]);
    frames[frame] = std::make_shared<const FrameEdges>(reader.Read(sequence.frames[frame].id));
  });
  const auto frame_of = [&](const Detection& detection) {
    return frames[static_cast<size_t>(detection.frame_index)];
  };
  for (const int index : use.symmetry) {
    const Detection& detection = detection_at(index);
    input->symmetry_images[index] =
        std::make_shared<const SymmetryImage>(frame_of(detection)->maps, detection.box);
  }
  for (const int index : use.edges) {
    const Detection& detection = detection_at(index);
    input->edge_images[index] = std::make_shared<const EdgeImage>(
        EdgeImage{frame_of(detection), detection.box, BoxesInFront(sequence, detection)});
  }
}

// Points of another dataset, or of other images, would be no evidence in silence. None at all is
// what soslam-track has warned of.
std::vector<MapPoint> ReadPointsOf(const Sequence& sequence, const StageFiles& files) {
  std::vector<MapPoint> points = ReadPoints(files.at("points"));
  std::set<int> frame_ids;
  for (const Frame& frame : sequence.frames) frame_ids.insert(frame.id);
  const auto is_seen = [&](const MapPoint& point) {
    return std::ranges::any_of(point.observations, [&](const PointObservation& observation) {
      return frame_ids.contains(observation.frame_id);
    });
  };
  if (!points.empty() && std::ranges::none_of(points, is_seen)) {
    throw InputError(fmt::format(
        "{}: observation_frame: none of {} points is seen in a frame of {}; expected ids of its {} "
        "frames: were the points made from another dataset?",
        files.at("points").string(), points.size(), files.at("sequence").string(),
        sequence.frames.size()));
  }
  return points;
}

}  // namespace

void RunOptimise(const OptimiseOptions& options, const StageFiles& files, int threads) {
  CheckEvidence(options, files);
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  const auto priors = ObjectPriors(sequence, table, options.ratio_prior, options.shape);
  const LandmarkEstimates estimates = ReadLandmarks(files.at("landmarks"), sequence);
  BackEndInput input{sequence, {}, priors, {}, {}};
  if (options.point_evidence) {
    input.points = FindObjectPoints(sequence, ReadPointsOf(sequence, files), options.points);
  }
  if (options.symmetry || options.edge_alignment) {
    ReadImages(options, files.at("edges"), threads, &input);
  }
  input.initial_landmarks = options.detection_model == DetectionModel::kTangency
                                ? ChooseInitialUprightLandmarks(input, estimates, options, threads)
                                : ChooseInitialLandmarks(sequence, estimates);
  if (std::ranges::none_of(input.initial_landmarks,
                           [](const auto& start) { return start.has_value(); })) {
    throw NothingUsableError(files.at("landmarks").string() + ": no landmark to start from");
  }
  ArtefactInfo info = {OptionsToJson(options),
                       {files.at("sequence"), files.at("landmarks"), files.at("table")}};
  if (options.symmetry || options.edge_alignment) {
    info.inputs.push_back(files.at("edges"));
  }
  if (options.point_evidence) info.inputs.push_back(files.at("points"));
  const MapEstimate map = OptimiseMap(input, options, threads);
  const LandmarkEstimates found = {{}, map.objects};
  info.findings = options.support ? CheckSizes(found, sequence, table) : CheckDegenerate(found);
  std::ranges::move(CheckCollapsed(found), std::back_inserter(info.findings));
  if (options.detection_model == DetectionModel::kTangency) {
    std::ranges::move(CheckCost(map.solver), std::back_inserter(info.findings));
  }
  std::ranges::move(CheckPoseCorrections(sequence, map.world_from_camera, options.Odometry()),
                    std::back_inserter(info.findings));
  ReportFindings("optimise", info.findings);
  WriteMap(files.at("output"), map, sequence, info);
  fmt::print("{} iterations, cost {:.6g} -> {:.6g}{}\n", map.solver.iterations,
             map.solver.initial_cost, map.solver.final_cost,
             map.solver.converged ? "" : ", not converged");
}

namespace {

bool IsMap(const std::filesystem::path& path) {
  const nlohmann::json json = ParseJsonFile(path);
  return json.is_object() && json.contains("artefact") && json["artefact"].is_object() &&
         json["artefact"].contains("kind") && json["artefact"]["kind"] == "map";
}

void PrintQuality(const MapQuality& quality) {
  for (const MapScore& score : quality.scores) {
    fmt::print(
        "IoU of at least {:g}: {} of {} true objects found ({} of {} detectable), {} of {} "
        "landmarks right, {} ignored; mean IoU of the found {}\n",
        score.min_iou, score.found, score.true_objects, score.found_detectable, score.detectable,
        score.found, score.landmarks - score.ignored, score.ignored,
        score.of_found.iou_mean ? fmt::format("{:.3f}", *score.of_found.iou_mean) : "-");
  }
  ReportFindings("evaluate", quality.alignments.findings);
}

}  // namespace

void RunEvaluate(const EvaluateOptions& options, const StageFiles& files, int /*threads*/) {
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const std::filesystem::path& landmarks = files.at("landmarks");
  const Metrics metrics =
      IsMap(landmarks)
          ? EvaluateMap(sequence, ReadMap(landmarks, sequence), options.alignment)
          : EvaluateLandmarks(sequence, ReadLandmarks(landmarks, sequence), options.alignment);
  WriteMetrics(files.at("output"), metrics, sequence,
               {OptionsToJson(options), {files.at("sequence"), landmarks}});
  if (const auto& held_out = metrics.held_out) {
    fmt::print("held-out frames: {} of {} detections matched, mean IoU {:.3f}\n",
               held_out->detections_matched, held_out->detections,
               held_out->iou_mean.value_or(0.0));
  }
  if (metrics.map_quality) PrintQuality(*metrics.map_quality);
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
