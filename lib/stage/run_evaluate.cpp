// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_evaluate.h"

#include <fmt/format.h>

#include "artefact/json_file.h"
#include "artefact/landmarks_file.h"
#include "artefact/map_file.h"
#include "artefact/metrics_file.h"
#include "artefact/sequence_file.h"
#include "cli/report_findings.h"
#include "evaluation/metrics.h"

namespace soslam {
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
