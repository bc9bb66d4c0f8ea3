// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/metrics_file.h"

#include "artefact/json_file.h"
#include "artefact/model_json.h"

namespace soslam {
namespace {

using nlohmann::json;

json AlignmentToJson(int segment, const Alignment& alignment) {
  return {{"segment", segment},
          {"kind", kAlignmentKindNames[static_cast<size_t>(alignment.kind)]},
          {"camera_path", kCameraPathNames[static_cast<size_t>(alignment.path)]},
          {"scale", alignment.scale},
          {"truth_from_scaled", alignment.truth_from_scaled},
          {"frames", alignment.frames},
          {"rmse_m", OrNull(alignment.rmse_m)}};
}

json PerAxis(const std::array<std::optional<double>, 3>& values) {
  return {OrNull(values[0]), OrNull(values[1]), OrNull(values[2])};
}

json FoundToJson(const FoundSummary& found) {
  return {{"iou_mean", OrNull(found.iou_mean)},
          {"centre_m_mean", OrNull(found.centre_m_mean)},
          {"centre_relative_mean", OrNull(found.centre_relative_mean)},
          {"log_size_mean", PerAxis(found.log_size_mean)},
          {"log_size_abs_mean", PerAxis(found.log_size_abs_mean)},
          {"log_scale_mean", OrNull(found.log_scale_mean)},
          {"log_scale_abs_mean", OrNull(found.log_scale_abs_mean)},
          {"yaw_error_deg_mean", OrNull(found.yaw_deg_mean)},
          {"up_error_deg_mean", OrNull(found.up_deg_mean)},
          {"plane_offset_m_abs_mean", OrNull(found.plane_offset_m_abs_mean)},
          {"plane_tilt_deg_mean", OrNull(found.plane_tilt_deg_mean)},
          {"quarter_turned", found.quarter_turned},
          {"labels_agree", found.labels_agree},
          {"ids_known", found.ids_known},
          {"ids_agree", found.ids_agree}};
}

json ScoreToJson(const MapScore& score) {
  return {{"min_iou", score.min_iou},
          {"true_objects", score.true_objects},
          {"detectable", score.detectable},
          {"landmarks", score.landmarks},
          {"ignored", score.ignored},
          {"found", score.found},
          {"found_detectable", score.found_detectable},
          {"precision", OrNull(score.precision)},
          {"recall", OrNull(score.recall)},
          {"f1", OrNull(score.f1)},
          {"recall_of_detectable", OrNull(score.recall_of_detectable)},
          {"f1_of_detectable", OrNull(score.f1_of_detectable)},
          {"of_found", FoundToJson(score.of_found)}};
}

json InFramesToJson(const DriftSummary& summary) {
  return {{"landmarks", summary.landmarks},
          {"iou_mean", OrNull(summary.iou_in_frames)},
          {"iou_mean_in_world", OrNull(summary.iou_in_world)},
          {"centre_m_median", OrNull(summary.centre_m_in_frames)},
          {"centre_m_median_in_world", OrNull(summary.centre_m_in_world)}};
}

// Adds the reason why a row is missed or false; null where it is neither.
void AddExplanation(const std::optional<Explanation>& explanation, json* row) {
  (*row)["reason"] =
      explanation ? json(kMapReasonNames.at(static_cast<size_t>(explanation->reason))) : json();
  (*row)["detail"] = explanation ? json(explanation->detail) : json();
}

json ObjectToJson(const TrueObjectRow& row, const MapQuality& quality, const Sequence& sequence) {
  const TrueObject& object = sequence.true_objects[static_cast<size_t>(row.true_index)];
  const auto landmark_id = [&](int landmark) {
    const LandmarkRow& found = quality.landmarks[static_cast<size_t>(landmark)];
    return sequence.objects[static_cast<size_t>(found.object_index)].id;
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
          {"yaw_error_deg", OrNull(errors.yaw_deg)},
          {"up_error_deg", errors.up_deg},
          {"quarter_turned", errors.is_quarter_turned}};
}

json LandmarkRowToJson(const LandmarkRow& row, const Sequence& sequence) {
  const Object& object = sequence.objects[static_cast<size_t>(row.object_index)];
  json fields = {{"object", object.id},
                 {"label", object.label},
                 {"fate", kLandmarkFateNames[static_cast<size_t>(row.fate)]},
                 {"true_object", json()},
                 {"errors", row.errors ? ErrorsToJson(*row.errors) : json()},
                 {"plane_offset_m", row.plane ? json(row.plane->offset_m) : json()},
                 {"plane_tilt_deg", row.plane ? json(row.plane->tilt_deg) : json()},
                 {"label_agrees", row.errors ? json(row.label_agrees) : json()},
                 {"id_agrees", OrNull(row.id_agrees)},
                 {"wrong_part", json()},
                 {"in_frames", json()}};
  if (row.true_index) {
    fields["true_object"] = sequence.true_objects[static_cast<size_t>(*row.true_index)].id;
  }
  if (row.wrong) {
    fields["wrong_part"] = {{"part", kBodyPartNames[static_cast<size_t>(row.wrong->part)]},
                            {"iou_corrected", row.wrong->iou}};
  }
  if (row.in_frames) {
    fields["in_frames"] = {{"observations", row.in_frames->observations},
                           {"iou_mean", row.in_frames->iou},
                           {"centre_m_mean", row.in_frames->centre_m}};
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
  json fields = {{"alignments", json::array()},
                 {"scores", json::array()},
                 {"in_frames", InFramesToJson(quality.in_frames)},
                 {"objects", json::array()},
                 {"landmarks", json::array()},
                 {"misses", CountsToJson(quality.misses)},
                 {"false_landmarks", CountsToJson(quality.false_landmarks)}};
  for (const auto& [segment, alignment] : quality.alignments.of_segment) {
    fields["alignments"].push_back(AlignmentToJson(segment, alignment));
  }
  for (const MapScore& score : quality.scores) fields["scores"].push_back(ScoreToJson(score));
  for (const TrueObjectRow& row : quality.objects) {
    fields["objects"].push_back(ObjectToJson(row, quality, sequence));
  }
  for (const LandmarkRow& row : quality.landmarks) {
    fields["landmarks"].push_back(LandmarkRowToJson(row, sequence));
  }
  return fields;
}

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
