// SPDX-License-Identifier: BSD-3-Clause
#include "report/quality_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace soslam {
namespace {

using nlohmann::json;

std::string Number(const json& value, int decimals) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), decimals) : kNoValue;
}

// "similarity 2.31": the kind, with the scale where it is estimated; of segments that differ, all.
std::string AlignmentInWords(const json& alignments) {
  std::set<std::string> texts;
  for (const json& alignment : alignments) {
    const auto kind = alignment.at("kind").get<std::string>();
    texts.insert(kind == "similarity"
                     ? fmt::format("{} {:.4g}", kind, alignment.at("scale").get<double>())
                     : kind);
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

// The distance (m) that alignments leave between camera centres: root mean square of all frames.
std::string ResidualInWords(const json& alignments) {
  double squares = 0.0;
  int frames = 0;
  for (const json& alignment : alignments) {
    if (alignment.at("rmse_m").is_null()) continue;
    const int count = alignment.at("frames").get<int>();
    squares += count * std::pow(alignment.at("rmse_m").get<double>(), 2);
    frames += count;
  }
  return frames == 0 ? kNoValue : fmt::format("{:.4f}", std::sqrt(squares / frames));
}

std::string Found(const json& score) {
  return fmt::format("{}, {}", score.at("found").get<int>(), Number(score.at("f1"), 3));
}

std::vector<Cell> QualityRow(const std::string& name, const json& quality) {
  const json& score = quality.at("scores").front();
  const json& strict = quality.at("scores").back();
  const json& found = score.at("of_found");
  const json& in_frames = quality.at("in_frames");
  const json& log_scale = found.at("log_scale_abs_mean");
  const auto count = [&](const char* key) { return score.at(key).get<int>(); };
  return {
      name,
      AlignmentInWords(quality.at("alignments")),
      ResidualInWords(quality.at("alignments")),
      fmt::format("{} ({})", count("true_objects"), count("detectable")),
      fmt::format("{} ({})", count("landmarks"), count("ignored")),
      Found(score),
      Found(strict),
      Number(score.at("recall_of_detectable"), 3),
      Number(found.at("iou_mean"), 3),
      Number(found.at("centre_m_mean"), 3),
      Number(found.at("centre_relative_mean"), 2),
      log_scale.is_number() ? fmt::format("{:.3f}", std::exp(log_scale.get<double>())) : kNoValue,
      Number(found.at("yaw_error_deg_mean"), 1),
      Number(found.at("up_error_deg_mean"), 1),
      fmt::format("{} of {}", found.at("labels_agree").get<int>(), count("found")),
      Number(in_frames.at("iou_mean"), 3),
      Number(in_frames.at("iou_mean_in_world"), 3)};
}

void AddMistakes(const char* kind, const json& rows, const char* id, Table* table) {
  for (const json& row : rows) {
    if (row.at("reason").is_null()) continue;
    auto reason = row.at("reason").get<std::string>();
    std::ranges::replace(reason, '_', ' ');
    table->rows.push_back(
        {kind, fmt::format("{} {}", row.at("label").get<std::string>(), row.at(id).get<int>()),
         reason, row.at("detail").get<std::string>()});
  }
}

}  // namespace

Table QualityTable(const std::string& dataset, const std::vector<NamedMetrics>& variants) {
  Table table;
  table.name = "map_quality_" + dataset;
  table.title = dataset + ": maps against all that is true";
  table.header = {"variant",
                  "alignment",
                  "residual m",
                  "true (detectable)",
                  "landmarks (ignored)",
                  "right at IoU 0.25, F1",
                  "right at IoU 0.5, F1",
                  "recall of detectable",
                  "mean IoU",
                  "centre m",
                  "centre / size",
                  "size off by factor",
                  "yaw deg",
                  "up deg",
                  "labels right",
                  "IoU in frames",
                  "IoU in world"};
  std::set<std::string> odometry;
  for (const auto& [name, metrics] : variants) {
    if (!metrics.is_object() || !metrics.contains("map_quality")) continue;
    table.rows.push_back(QualityRow(name, metrics["map_quality"]));
    odometry.insert(metrics.value("odometry_source", ""));
  }
  odometry.erase("");
  if (!odometry.empty()) {
    table.notes.push_back(fmt::format("Odometry: {}.", fmt::join(odometry, ", ")));
  }
  return table;
}

Table QualityTable(const DatasetResult& dataset) {
  std::vector<NamedMetrics> variants;
  for (const VariantResult& variant : dataset.variants) {
    variants.emplace_back(variant.name, variant.metrics);
  }
  return QualityTable(dataset.name, variants);
}

Table MistakesTable(const json& metrics) {
  Table table;
  table.name = "sentences";
  table.header = {"", "object", "reason", "detail"};
  if (!metrics.contains("map_quality")) return table;
  AddMistakes("missed", metrics["map_quality"].at("objects"), "true_object", &table);
  AddMistakes("false", metrics["map_quality"].at("landmarks"), "object", &table);
  return table;
}

}  // namespace soslam
