// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/files.h"
#include "artefact/json_file.h"
#include "artefact/model_json.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WhatIf, yaw, quarter_turn, place, size)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MetricsSummary, objects, observations, iou_mean, iou_median,
                                   rotation_deg_mean, rotation_deg_median, yaw_error_deg_mean,
                                   yaw_error_deg_median, what_if)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrajectoryMetrics, ate_rmse_m, odometry_ate_rmse_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FoundSummary, iou_mean, centre_m_mean, centre_relative_mean,
                                   log_size_mean, log_size_abs_mean, log_scale_mean,
                                   log_scale_abs_mean, yaw_error_deg_mean, up_error_deg_mean,
                                   plane_offset_m_abs_mean, plane_tilt_deg_mean, quarter_turned,
                                   labels_agree, ids_known, ids_agree)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MapScore, min_iou, true_objects, detectable, landmarks, ignored,
                                   found, found_detectable, precision, recall, f1,
                                   recall_of_detectable, f1_of_detectable, of_found)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DriftSummary, landmarks, iou_mean, iou_mean_in_world,
                                   centre_m_median, centre_m_median_in_world, what_if)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HeldOutObject, in_sight, in_sight_matched, matched, iou_mean)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HeldOutMetrics, frames, detections, detections_matched, in_sight,
                                   in_sight_matched, iou_mean, iou_median, iou_mean_of_detections)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(InFrames, observations, iou_mean, centre_m_mean, what_if)

namespace {

using nlohmann::json;

json AlignmentToJson(const std::pair<const int, Alignment>& of_segment) {
  const auto& [segment, alignment] = of_segment;
  return {{"segment", segment},
          {"kind", kAlignmentKindNames[static_cast<size_t>(alignment.kind)]},
          {"camera_path", kCameraPathNames[static_cast<size_t>(alignment.path)]},
          {"scale", alignment.scale},
          {"truth_from_scaled", alignment.truth_from_scaled},
          {"frames", alignment.frames},
          {"rmse_m", alignment.rmse_m}};
}

// Adds the reason why a row is missed or false; null where it is neither.
void AddExplanation(const std::optional<Explanation>& explanation, json* row) {
  (*row)["reason"] =
      explanation ? json(kMapReasonNames.at(static_cast<size_t>(explanation->reason))) : json();
  (*row)["detail"] = explanation ? json(explanation->detail) : json();
}

json TrueObjectRowToJson(const TrueObjectRow& row, const MapQuality& quality,
                         const Sequence& sequence) {
  const TrueObject& object = sequence.true_objects[row.true_index];
  const auto landmark_id = [&](int landmark) {
    const LandmarkRow& found = quality.landmarks[landmark];
    return sequence.objects[found.object_index].id;
  };
  json fields = {{"true_object", object.id},
                 {"label", object.label},
                 {"detected_frames", row.detected_frames},
                 {"detectable", row.is_detectable},
                 {"object", row.landmark ? json(landmark_id(*row.landmark)) : json()}};
  AddExplanation(row.miss, &fields);
  return fields;
}

json ErrorsToJson(const BodyErrors& errors) {
  return {{"iou", errors.iou},
          {"centre_m", errors.centre_m},
          {"centre_relative", errors.centre_relative},
          {"log_size", {errors.log_size.x(), errors.log_size.y(), errors.log_size.z()}},
          {"log_scale", errors.log_scale},
          {"yaw_error_deg", errors.yaw_deg},
          {"up_error_deg", errors.up_deg},
          {"quarter_turned", errors.is_quarter_turned}};
}

json LandmarkRowToJson(const LandmarkRow& row, const Sequence& sequence) {
  const Object& object = sequence.objects[row.object_index];
  json fields = {{"object", object.id},
                 {"label", object.label},
                 {"fate", kLandmarkFateNames[static_cast<size_t>(row.fate)]},
                 {"true_object", json()},
                 {"errors", row.errors ? ErrorsToJson(*row.errors) : json()},
                 {"plane_offset_m", row.plane ? json(row.plane->offset_m) : json()},
                 {"plane_tilt_deg", row.plane ? json(row.plane->tilt_deg) : json()},
                 {"label_agrees", row.errors ? json(row.label_agrees) : json()},
                 {"id_agrees", row.id_agrees},
                 {"in_frames", row.in_frames}};
  if (row.true_index) {
    fields["true_object"] = sequence.true_objects[*row.true_index].id;
  }
  AddExplanation(row.why_false, &fields);
  return fields;
}

json CountsToJson(const std::map<MapReason, int>& counts) {
  json fields = json::object();
  for (const auto& [reason, count] : counts) {
    fields[kMapReasonNames.at(static_cast<size_t>(reason))] = count;
  }
  return fields;
}

// The field "map_quality" of metrics.json.
json MapQualityToJson(const MapQuality& quality, const Sequence& sequence) {
  return {{"alignments", ListToJson(quality.alignments.of_segment, &AlignmentToJson)},
          {"scores", quality.scores},
          {"in_frames", quality.in_frames},
          {"objects", ListToJson(quality.objects, &TrueObjectRowToJson, quality, sequence)},
          {"landmarks", ListToJson(quality.landmarks, &LandmarkRowToJson, sequence)},
          {"misses", CountsToJson(quality.misses)},
          {"false_landmarks", CountsToJson(quality.false_landmarks)}};
}

json ObjectMetricsToJson(const ObjectMetrics& metrics, const Sequence& sequence) {
  const Object& object = sequence.objects[metrics.object_index];
  return {{"object", object.id},
          {"label", object.label},
          {"observations", metrics.observations},
          {"estimates", metrics.estimates},
          {"iou", metrics.observations > 0 ? json(metrics.iou) : json()},
          {"centre_m", metrics.centre_m},
          {"rotation_deg", metrics.rotation_deg},
          {"yaw_error_deg", metrics.yaw_deg},
          {"attitude_error_deg", metrics.attitude_deg},
          {"what_if", metrics.what_if}};
}

json HeldOutMetricsToJson(const HeldOutMetrics& metrics, const Sequence& sequence) {
  json fields = metrics;
  fields["min_iou"] = kMinHeldOutIou;
  fields["objects"] = metrics.objects;
  for (size_t i = 0; i < metrics.objects.size(); ++i) {
    const Object& object = sequence.objects[metrics.objects[i].object_index];
    fields["objects"][i].update({{"object", object.id}, {"label", object.label}});
  }
  return fields;
}

}  // namespace

void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info) {
  json body = {{"dataset", sequence.name},
               {"summary", metrics.summary},
               {"first_observation", metrics.first_observation},
               {"objects", ListToJson(metrics.objects, &ObjectMetricsToJson, sequence)},
               {"trajectory", metrics.trajectory}};
  if (metrics.held_out) body["held_out"] = HeldOutMetricsToJson(*metrics.held_out, sequence);
  if (!sequence.odometry_source.empty()) body["odometry_source"] = sequence.odometry_source;
  ArtefactInfo with_findings = info;
  if (const auto& quality = metrics.map_quality) {
    body["map_quality"] = MapQualityToJson(*quality, sequence);
    with_findings.findings = quality->alignments.findings;
  }
  WriteArtefact(path, "metrics", with_findings, std::move(body));
}

}  // namespace soslam
