// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/base/table.h"
#include "soslam/evaluation/statistics.h"
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
    Sequence sequence;
    sequence.name = dataset;
    Metrics metrics;
    metrics.summary = Summary(objects);
    for (const ObjectErrors& object : objects) {
      const int index = static_cast<int>(sequence.objects.size());
      sequence.objects.push_back({object.id, "box", 0, {}});
      metrics.objects.push_back({index, object.observations, 1, object.iou, 0.0,
                                 object.rotation_deg, object.rotation_deg});
    }
    if (is_single_frame) {
      metrics.first_observation = metrics.summary;
      metrics.first_observation->observations = metrics.summary.objects;
    }
    soslam::WriteMetrics(VariantFolder(dataset, variant) / "metrics.json", metrics, sequence, {});
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
  static MetricsSummary Summary(const std::vector<ObjectErrors>& objects) {
    std::vector<double> ious, angles;
    int observations = 0;
    for (const ObjectErrors& object : objects) {
      ious.push_back(object.iou);
      if (object.rotation_deg) angles.push_back(*object.rotation_deg);
      observations += object.observations;
    }
    const auto iou = MeanOf(ious), angle = MeanOf(angles);
    return {static_cast<int>(objects.size()), observations, iou, iou, angle, angle, angle, angle};
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
