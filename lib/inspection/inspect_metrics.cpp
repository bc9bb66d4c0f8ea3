// SPDX-License-Identifier: BSD-3-Clause
// Metrics: rows are objects, or landmarks if their true objects are unknown.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "artefact/json_file.h"
#include "inspection/kinds.h"
#include "inspection/map_quality_in_words.h"

namespace soslam {
namespace {

using nlohmann::json;

std::string OrDash(const json& number, int decimals) {
  return number.is_null() ? "-" : fmt::format("{:.{}f}", number.get<double>(), decimals);
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

std::string TrajectoryInWords(const json& trajectory) {
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
    add("trajectory", "trajectory", TrajectoryInWords);
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
