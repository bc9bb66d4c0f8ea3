// SPDX-License-Identifier: BSD-3-Clause
// Metrics: rows are objects, or landmarks if their true objects are unknown.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>

#include "artefact/json_file.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr const char* kAlignment =
    "{kind}, scale {scale:.4g}; cameras {rmse_m:.4f} m from the true ones ({frames} frames, path: "
    "{camera_path})";
constexpr const char* kScore =
    "{found} of {true_objects} objects found ({found_detectable} of the {detectable} detectable), "
    "{found} of {judged} landmarks right, {ignored} ignored; precision {precision:.3f}, recall "
    "{recall:.3f} (of detectable {recall_of_detectable:.3f}), F1 {f1:.3f} (of detectable "
    "{f1_of_detectable:.3f})";
// Means over the found landmarks, of absolute values.
constexpr const char* kOfFound =
    "mean IoU {of_found/iou_mean:.3f}, centre {of_found/centre_m_mean:.3f} m "
    "({of_found/centre_relative_mean:.2f} of the size), log scale "
    "{of_found/log_scale_abs_mean:.3f}, log size {of_found/log_size_abs_mean/0:.2f}, "
    "{of_found/log_size_abs_mean/1:.2f}, {of_found/log_size_abs_mean/2:.2f}, yaw of body "
    "{of_found/yaw_error_deg_mean:.2f} deg, up {of_found/up_error_deg_mean:.2f} deg, plane "
    "{of_found/plane_offset_m_abs_mean:.3f} m and {of_found/plane_tilt_deg_mean:.1f} deg; "
    "{of_found/labels_agree} of {found} labels right, {of_found/ids_agree} of "
    "{of_found/ids_known} ids agree, {of_found/quarter_turned} turned by a quarter";
constexpr const char* kInFrames =
    "{landmarks} landmarks: mean IoU {iou_mean:.3f}, in the world {iou_mean_in_world:.3f}; median "
    "centre {centre_m_median:.3f} m, in the world {centre_m_median_in_world:.3f} m; mean IoU with "
    "the true yaw {what_if/yaw:.3f}, the best quarter turn {what_if/quarter_turn:.3f}, the true "
    "place {what_if/place:.3f}, the true size {what_if/size:.3f}";
constexpr const char* kSummary =
    "IoU {iou_mean:.3f} (median {iou_median:.3f}), rotation error {rotation_deg_mean:.2f} (median "
    "{rotation_deg_median:.2f}) deg, yaw error {yaw_error_deg_mean:.2f} (median "
    "{yaw_error_deg_median:.2f}) deg; {objects} objects, {observations} observations";
constexpr const char* kTrajectory =
    "root mean square error {ate_rmse_m:.4f} m, of the odometry {odometry_ate_rmse_m:.4f} m";
constexpr const char* kHeldOut =
    "in {frames} frames: {detections_matched} of {detections} detections match a landmark, "
    "{in_sight_matched} of {in_sight} landmarks in sight match a detection (IoU of at least "
    "{min_iou:g}); mean IoU of matches {iou_mean:.3f}";

// One line for each row that has a reason, if they are few.
std::vector<Fact> Reasons(const json& rows, const char* id, const std::string& name) {
  constexpr size_t kMost = 20;
  std::vector<Fact> facts;
  for (const json& row : rows) {
    if (row.at("reason").is_null()) continue;
    if (facts.size() == kMost) {
      facts.push_back({name, "... and more"});
      break;
    }
    facts.push_back({name, fmt::format("{} {}", row.at(id).get<int>(),
                                       FillIn(row.at("detail").get<std::string>().empty()
                                                  ? "({label}): {reason}"
                                                  : "({label}): {reason}; {detail}",
                                              row))});
  }
  return facts;
}

// Summary of map_quality of metrics.json: the map as a whole, and the reasons for missed objects
// and false landmarks, one by one if they are few.
std::vector<Fact> MapQualityFacts(const json& quality) {
  std::vector<Fact> facts;
  for (const json& alignment : quality.at("alignments")) {
    const int segment = alignment.at("segment").get<int>();
    const bool is_only = quality["alignments"].size() == 1;
    facts.push_back({is_only ? "alignment" : fmt::format("alignment {}", segment),
                     FillIn(kAlignment, alignment)});
  }
  for (const json& score : quality.at("scores")) {
    const std::string name = fmt::format("IoU >= {:g}", score.at("min_iou").get<double>());
    json fields = score;
    fields["judged"] = score.at("landmarks").get<int>() - score.at("ignored").get<int>();
    facts.push_back({name, FillIn(kScore, fields)});
    facts.push_back({"found", FillIn(kOfFound, fields)});
  }
  if (quality.at("in_frames").at("landmarks") != 0) {
    facts.push_back({"in frames", FillIn(kInFrames, quality.at("in_frames"))});
  }
  for (const auto& part : {Reasons(quality.at("objects"), "true_object", "missed"),
                           Reasons(quality.at("landmarks"), "object", "false")}) {
    facts.insert(facts.end(), part.begin(), part.end());
  }
  return facts;
}

// One row for each landmark.
ValueTable MapQualityTable(const json& quality) {
  return TableOf({{"object"},
                  {"label"},
                  {"fate"},
                  {"true_object"},
                  {"iou", "", 3, "errors/iou"},
                  {"centre_error", "m", 3, "errors/centre_m"},
                  {"log_scale", "", 3, "errors/log_scale"},
                  {"yaw_error", "deg", 2, "errors/yaw_error_deg"},
                  {"up_error", "deg", 2, "errors/up_error_deg"},
                  {"plane_offset", "m", 3, "plane_offset_m"},
                  {"plane_tilt", "deg", 2, "plane_tilt_deg"},
                  {"iou_in_frames", "", 3, "in_frames/iou_mean"},
                  {"with_true_yaw", "", 3, "in_frames/what_if/yaw"},
                  {"with_quarter_turn", "", 3, "in_frames/what_if/quarter_turn"},
                  {"with_true_place", "", 3, "in_frames/what_if/place"},
                  {"with_true_size", "", 3, "in_frames/what_if/size"},
                  {"reason"}},
                 quality.at("landmarks"));
}

// One row per object with ground truth, and per landmark that was evaluated in held-out frames.
ValueTable ObjectTable(const json& document) {
  std::map<int, json> by_id;
  for (const json& object : document.at("objects")) by_id[object.at("object")] = object;
  const json held_out = document.value("held_out", json::object());
  for (const json& object : held_out.value("objects", json::array())) {
    by_id[object.at("object")].update(object);
  }
  json objects = json::array();
  for (const auto& [id, object] : by_id) objects.push_back(object);
  return TableOf({{"object"},
                  {"label"},
                  {"observations"},
                  {"estimates"},
                  {"iou", "", 3},
                  {"centre_error", "m", 3, "centre_m"},
                  {"rotation_error", "deg", 2, "rotation_deg"},
                  {"yaw_error", "deg", 2, "yaw_error_deg"},
                  {"attitude_error", "deg", 2, "attitude_error_deg"},
                  {"held_out_in_sight", "", 2, "in_sight"},
                  {"held_out_matched", "", 2, "matched"},
                  {"held_out_iou", "", 3, "iou_mean"}},
                 objects);
}

}  // namespace

Inspection InspectMetrics(const json& document) {
  Inspection inspection;
  inspection.facts = {{"dataset", document.at("dataset")},
                      {"all", FillIn(kSummary, document.at("summary"))}};
  const auto add = [&](const std::string& name, const char* field, const char* text) {
    const json part = document.value(field, json());
    if (!part.is_null()) inspection.facts.push_back({name, FillIn(text, part)});
  };
  add("first views", "first_observation", kSummary);
  add("trajectory", "trajectory", kTrajectory);
  add("held out", "held_out", kHeldOut);
  inspection.table = ObjectTable(document);
  if (const json quality = document.value("map_quality", json()); !quality.is_null()) {
    std::ranges::move(MapQualityFacts(quality), std::back_inserter(inspection.facts));
    if (inspection.table.rows.empty()) inspection.table = MapQualityTable(quality);
  }
  return inspection;
}

}  // namespace soslam
