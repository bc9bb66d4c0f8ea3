// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/metrics_file.h"

#include "artefact/map_quality_json.h"

namespace soslam {
namespace {

nlohmann::json ToJson(const MetricsSummary& summary) {
  return {{"objects", summary.objects},
          {"observations", summary.observations},
          {"iou_mean", OrNull(summary.iou_mean)},
          {"iou_median", OrNull(summary.iou_median)},
          {"rotation_deg_mean", OrNull(summary.rotation_deg_mean)},
          {"rotation_deg_median", OrNull(summary.rotation_deg_median)},
          {"yaw_error_deg_mean", OrNull(summary.yaw_error_deg_mean)},
          {"yaw_error_deg_median", OrNull(summary.yaw_error_deg_median)}};
}

nlohmann::json ToJson(const ObjectMetrics& metrics, const Sequence& sequence) {
  const Object& object = sequence.objects[static_cast<size_t>(metrics.object_index)];
  return {{"object", object.id},
          {"label", object.label},
          {"observations", metrics.observations},
          {"estimates", metrics.estimates},
          {"iou", metrics.observations > 0 ? nlohmann::json(metrics.iou) : nlohmann::json()},
          {"centre_m", OrNull(metrics.centre_m)},
          {"rotation_deg", OrNull(metrics.rotation_deg)},
          {"yaw_error_deg", OrNull(metrics.yaw_deg)}};
}

nlohmann::json ToJson(const HeldOutMetrics& metrics, const Sequence& sequence) {
  nlohmann::json json = {{"frames", metrics.frames},
                         {"min_iou", kMinHeldOutIou},
                         {"detections", metrics.detections},
                         {"detections_matched", metrics.detections_matched},
                         {"in_sight", metrics.in_sight},
                         {"in_sight_matched", metrics.in_sight_matched},
                         {"iou_mean", OrNull(metrics.iou_mean)},
                         {"iou_median", OrNull(metrics.iou_median)},
                         {"iou_mean_of_detections", OrNull(metrics.iou_mean_of_detections)},
                         {"objects", nlohmann::json::array()}};
  for (const HeldOutObject& one : metrics.objects) {
    const Object& object = sequence.objects[static_cast<size_t>(one.object_index)];
    json["objects"].push_back({{"object", object.id},
                               {"label", object.label},
                               {"in_sight", one.in_sight},
                               {"in_sight_matched", one.in_sight_matched},
                               {"matched", one.matched},
                               {"iou_mean", OrNull(one.iou_mean)}});
  }
  return json;
}

}  // namespace

void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info) {
  nlohmann::json body = {{"dataset", sequence.name},
                         {"summary", ToJson(metrics.summary)},
                         {"first_observation", nlohmann::json()},
                         {"objects", nlohmann::json::array()},
                         {"trajectory", nlohmann::json()}};
  if (metrics.first_observation) body["first_observation"] = ToJson(*metrics.first_observation);
  for (const ObjectMetrics& object : metrics.objects) {
    body["objects"].push_back(ToJson(object, sequence));
  }
  if (metrics.trajectory) {
    body["trajectory"] = {{"ate_rmse_m", metrics.trajectory->ate_rmse_m},
                          {"odometry_ate_rmse_m", metrics.trajectory->odometry_ate_rmse_m}};
  }
  if (metrics.held_out) body["held_out"] = ToJson(*metrics.held_out, sequence);
  if (!sequence.odometry_source.empty()) body["odometry_source"] = sequence.odometry_source;
  ArtefactInfo with_findings = info;
  if (const auto& quality = metrics.map_quality) {
    body["map_quality"] = MapQualityToJson(*quality, sequence);
    with_findings.findings = quality->alignments.findings;
  }
  WriteArtefact(path, "metrics", with_findings, std::move(body));
}

}  // namespace soslam
