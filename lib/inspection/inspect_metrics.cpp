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

std::string OrDash(const json& number, int decimals) {
  return number.is_null() ? "-" : fmt::format("{:.{}f}", number.get<double>(), decimals);
}

std::string InWords(const json& alignment) {
  return fmt::format("{}, scale {:.4g}; cameras {} m from the true ones ({} frames, path: {})",
                     alignment.at("kind").get<std::string>(), alignment.at("scale").get<double>(),
                     OrDash(alignment.at("rmse_m"), 4), alignment.at("frames").get<int>(),
                     alignment.at("camera_path").get<std::string>());
}

std::string ScoreInWords(const json& score) {
  const auto count = [&](const char* name) { return score.at(name).get<int>(); };
  return fmt::format(
      "{} of {} objects found ({} of {} detectable), {} of {} landmarks right, {} ignored; "
      "precision {}, recall {} (of detectable {}), F1 {} (of detectable {})",
      count("found"), count("true_objects"), count("found_detectable"), count("detectable"),
      count("found"), count("landmarks") - count("ignored"), count("ignored"),
      OrDash(score.at("precision"), 3), OrDash(score.at("recall"), 3),
      OrDash(score.at("recall_of_detectable"), 3), OrDash(score.at("f1"), 3),
      OrDash(score.at("f1_of_detectable"), 3));
}

// Means over the found landmarks, of absolute values.
std::string FoundInWords(const json& score) {
  const json& found = score.at("of_found");
  const json& log_size = found.at("log_size_abs_mean");
  return fmt::format(
      "mean IoU {}, centre {} m ({} of the size), log scale {}, log size {}, {}, {}, yaw {} deg, "
      "up {} deg, plane {} m and {} deg; {} of {} labels right, {} of {} ids agree, {} turned by a "
      "quarter",
      OrDash(found.at("iou_mean"), 3), OrDash(found.at("centre_m_mean"), 3),
      OrDash(found.at("centre_relative_mean"), 2), OrDash(found.at("log_scale_abs_mean"), 3),
      OrDash(log_size.at(0), 2), OrDash(log_size.at(1), 2), OrDash(log_size.at(2), 2),
      OrDash(found.at("yaw_error_deg_mean"), 2), OrDash(found.at("up_error_deg_mean"), 2),
      OrDash(found.at("plane_offset_m_abs_mean"), 3), OrDash(found.at("plane_tilt_deg_mean"), 1),
      found.at("labels_agree").get<int>(), score.at("found").get<int>(),
      found.at("ids_agree").get<int>(), found.at("ids_known").get<int>(),
      found.at("quarter_turned").get<int>());
}

std::string InFramesInWords(const json& in_frames) {
  return fmt::format(
      "{} landmarks: mean IoU {}, in the world {}; median centre {} m, in the world {} m",
      in_frames.at("landmarks").get<int>(), OrDash(in_frames.at("iou_mean"), 3),
      OrDash(in_frames.at("iou_mean_in_world"), 3), OrDash(in_frames.at("centre_m_median"), 3),
      OrDash(in_frames.at("centre_m_median_in_world"), 3));
}

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
    const auto detail = row.at("detail").get<std::string>();
    facts.push_back(
        {name,
         fmt::format("{} ({}): {}{}{}", row.at(id).get<int>(), row.at("label").get<std::string>(),
                     row.at("reason").get<std::string>(), detail.empty() ? "" : "; ", detail)});
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
    facts.push_back(
        {is_only ? "alignment" : fmt::format("alignment {}", segment), InWords(alignment)});
  }
  for (const json& score : quality.at("scores")) {
    const std::string name = fmt::format("IoU >= {:g}", score.at("min_iou").get<double>());
    facts.push_back({name, ScoreInWords(score)});
    facts.push_back({"found", FoundInWords(score)});
  }
  if (quality.at("in_frames").at("landmarks") != 0) {
    facts.push_back({"in frames", InFramesInWords(quality.at("in_frames"))});
  }
  for (const auto& part : {Reasons(quality.at("objects"), "true_object", "missed"),
                           Reasons(quality.at("landmarks"), "object", "false")}) {
    facts.insert(facts.end(), part.begin(), part.end());
  }
  return facts;
}

// One row for each landmark.
ValueTable MapQualityTable(const json& quality) {
  ValueTable table;
  table.columns = {{"object", ""},           {"label", ""},         {"fate", ""},
                   {"true_object", ""},      {"iou", "", 3},        {"centre_error", "m", 3},
                   {"log_scale", "", 3},     {"yaw_error", "deg"},  {"up_error", "deg"},
                   {"plane_offset", "m", 3}, {"plane_tilt", "deg"}, {"iou_in_frames", "", 3},
                   {"wrong_part", ""},       {"reason", ""}};
  for (const json& row : quality.at("landmarks")) {
    const json errors = row.at("errors").is_null() ? json::object() : row["errors"];
    const json in_frames = row.at("in_frames").is_null() ? json::object() : row["in_frames"];
    const json wrong = row.at("wrong_part").is_null() ? json::object() : row["wrong_part"];
    table.rows.push_back({row.at("object"), row.at("label"), row.at("fate"), row.at("true_object"),
                          errors.value("iou", json()), errors.value("centre_m", json()),
                          errors.value("log_scale", json()), errors.value("yaw_error_deg", json()),
                          errors.value("up_error_deg", json()), row.at("plane_offset_m"),
                          row.at("plane_tilt_deg"), in_frames.value("iou_mean", json()),
                          wrong.value("part", json()), row.at("reason")});
  }
  return table;
}

// Means and medians of a summary.
std::string SummaryInWords(const json& summary) {
  const auto both = [&](const std::string& name, int decimals) {
    return fmt::format("{} (median {})", OrDash(summary.at(name + "_mean"), decimals),
                       OrDash(summary.at(name + "_median"), decimals));
  };
  return fmt::format("IoU {}, rotation error {} deg, yaw error {} deg; {} objects, {} observations",
                     both("iou", 3), both("rotation_deg", 2), both("yaw_error_deg", 2),
                     summary.at("objects").get<int>(), summary.at("observations").get<int>());
}

std::string TrajectoryErrorInWords(const json& trajectory) {
  return fmt::format("root mean square error {:.4f} m, of the odometry {:.4f} m",
                     trajectory.at("ate_rmse_m").get<double>(),
                     trajectory.at("odometry_ate_rmse_m").get<double>());
}

std::string HeldOutInWords(const json& held_out) {
  return fmt::format(
      "in {} frames: {} of {} detections match a landmark, {} of {} landmarks in sight match a "
      "detection (IoU of at least {:g}); mean IoU of matches {}",
      held_out.at("frames").get<int>(), held_out.at("detections_matched").get<int>(),
      held_out.at("detections").get<int>(), held_out.at("in_sight_matched").get<int>(),
      held_out.at("in_sight").get<int>(), held_out.at("min_iou").get<double>(),
      OrDash(held_out.at("iou_mean"), 3));
}

std::vector<Value> Cells(const json& object, const std::vector<const char*>& fields) {
  std::vector<Value> cells;
  for (const char* field : fields) cells.push_back(object.value(field, json()));
  return cells;
}

// One row per object with ground truth, and per landmark that was evaluated in held-out frames.
ValueTable ObjectTable(const json& document) {
  std::map<int, json> by_id;
  for (const json& object : document.at("objects")) by_id[object.at("object")] = object;
  const json held_out = document.value("held_out", json::object());
  for (const json& object : held_out.value("objects", json::array())) {
    json& merged = by_id[object.at("object")];
    for (const auto& [name, value] : object.items()) merged[name] = value;
  }
  ValueTable table;
  table.columns = {{"object", ""},
                   {"label", ""},
                   {"observations", ""},
                   {"estimates", ""},
                   {"iou", "", 3},
                   {"centre_error", "m", 3},
                   {"rotation_error", "deg"},
                   {"yaw_error", "deg"},
                   {"held_out_in_sight", ""},
                   {"held_out_matched", ""},
                   {"held_out_iou", "", 3}};
  for (const auto& [id, object] : by_id) {
    table.rows.push_back(
        Cells(object, {"object", "label", "observations", "estimates", "iou", "centre_m",
                       "rotation_deg", "yaw_error_deg", "in_sight", "matched", "iou_mean"}));
  }
  return table;
}

}  // namespace

Inspection InspectMetrics(const std::filesystem::path& file) {
  return ReadArtefactAs(file, "metrics", [](const json& document) {
    Inspection inspection;
    inspection.facts = {{"dataset", document.at("dataset")},
                        {"all", SummaryInWords(document.at("summary"))}};
    const auto add = [&](const std::string& name, const char* field, const auto& in_words) {
      const json part = document.value(field, json());
      if (!part.is_null()) inspection.facts.push_back({name, in_words(part)});
    };
    add("first views", "first_observation", SummaryInWords);
    add("trajectory", "trajectory", TrajectoryErrorInWords);
    add("held out", "held_out", HeldOutInWords);
    inspection.table = ObjectTable(document);
    if (const json quality = document.value("map_quality", json()); !quality.is_null()) {
      std::ranges::move(MapQualityFacts(quality), std::back_inserter(inspection.facts));
      if (inspection.table.rows.empty()) inspection.table = MapQualityTable(quality);
    }
    return inspection;
  });
}

}  // namespace soslam
