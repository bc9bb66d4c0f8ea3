// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "artefact/json_file.h"
#include "base/table.h"
#include "support/temporary_folder.h"

namespace soslam {

// Errors of one object in a metrics.json that a test writes.
struct ObjectErrors {
  int id = 1;
  double iou = 0.0;
  std::optional<double> rotation_deg = std::nullopt;  // the yaw error is the same
  int observations = 1;
};

// A results folder with files as the stages write them.
class ResultsFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path VariantFolder(const std::string& dataset,
                                      const std::string& variant) const {
    const std::filesystem::path folder = path() / dataset / variant;
    std::filesystem::create_directories(folder);
    return folder;
  }

  // metrics.json with the means over `objects`; those of the first observation, if it is to have
  // some, are the same.
  void WriteMetrics(const std::string& dataset, const std::string& variant,
                    const std::vector<ObjectErrors>& objects, bool is_single_frame = false) const {
    nlohmann::json summary = Summary(objects);
    nlohmann::json body = {{"dataset", dataset},
                           {"summary", summary},
                           {"first_observation", nlohmann::json()},
                           {"objects", nlohmann::json::array()},
                           {"trajectory", nlohmann::json()}};
    if (is_single_frame) {
      summary["observations"] = objects.size();
      body["first_observation"] = summary;
    }
    for (const ObjectErrors& object : objects) {
      body["objects"].push_back({{"object", object.id},
                                 {"label", "box"},
                                 {"observations", object.observations},
                                 {"estimates", 1},
                                 {"iou", object.iou},
                                 {"centre_m", 0.0},
                                 {"rotation_deg", object.rotation_deg},
                                 {"yaw_error_deg", object.rotation_deg}});
    }
    WriteArtefact(VariantFolder(dataset, variant) / "metrics.json", "metrics", {}, body);
  }

  // stages.txt of a variant: runs are <stage>-<key>.
  void WriteStages(const std::string& dataset, const std::string& variant,
                   const std::vector<std::string>& runs) const {
    std::string lines;
    for (const std::string& run : runs) lines += run + "\n";
    WriteBytes(VariantFolder(dataset, variant) / "stages.txt", lines);
  }

  void WriteTiming(const std::string& dataset, const std::string& run, double wall_s,
                   double cpu_s) const {
    const nlohmann::json timing = {{"stage", "soslam-" + run.substr(0, run.rfind('-'))},
                                   {"wall_s", wall_s},
                                   {"cpu_s", cpu_s},
                                   {"peak_memory_mb", 10.0},
                                   {"threads", 2},
                                   {"machine", {{"cpu", "A CPU"}, {"cores", 4}}}};
    WriteBytes(VariantFolder(dataset, "shared/" + run) / "timing.json", timing.dump());
  }

 private:
  static nlohmann::json Summary(const std::vector<ObjectErrors>& objects) {
    double iou = 0.0, rotation = 0.0;
    int angles = 0, observations = 0;
    for (const ObjectErrors& object : objects) {
      iou += object.iou;
      rotation += object.rotation_deg.value_or(0.0);
      angles += object.rotation_deg ? 1 : 0;
      observations += object.observations;
    }
    nlohmann::json iou_mean;
    if (!objects.empty()) iou_mean = iou / static_cast<double>(objects.size());
    const nlohmann::json angle_mean = angles > 0 ? nlohmann::json(rotation / angles) : nullptr;
    return {{"objects", objects.size()},
            {"observations", observations},
            {"iou_mean", iou_mean},
            {"iou_median", iou_mean},
            {"rotation_deg_mean", angle_mean},
            {"rotation_deg_median", angle_mean},
            {"yaw_error_deg_mean", angle_mean},
            {"yaw_error_deg_median", angle_mean}};
  }

  TemporaryFolder folder_;
};

// The rows of a table, each with its cells divided by blanks and bold ones between stars.
inline std::vector<std::string> CellTexts(const Table& table) {
  std::vector<std::string> lines;
  for (const auto& row : table.rows) {
    std::string line;
    for (const Cell& cell : row) {
      line += (line.empty() ? "" : " ") + (cell.bold ? "*" + cell.text + "*" : cell.text);
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace soslam
