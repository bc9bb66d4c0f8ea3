// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "evaluation/map_reasons.h"
#include "inspection/inspection.h"
#include "report/page_html.h"
#include "report/tables.h"

namespace soslam {
namespace {

struct Column {
  const char* title;
  const char* pointer;  // JSON pointer into metrics.json
  int decimals;
};
constexpr std::array<Column, 8> kColumns = {{
    {"objects", "/summary/objects", 0},
    {"observations", "/summary/observations", 0},
    {"IoU (all)", "/summary/iou_mean", 3},
    {"IoU (first)", "/first_observation/iou_mean", 3},
    {"Rot deg (all)", "/summary/rotation_deg_mean", 2},
    {"Rot deg (first)", "/first_observation/rotation_deg_mean", 2},
    {"yaw error deg", "/summary/yaw_error_deg_mean", 2},
    {"ATE m", "/trajectory/ate_rmse_m", 4},
}};

std::vector<Cell> RowOf(const VariantResult& variant) {
  std::vector<Cell> row = {variant.name};
  for (const Column& column : kColumns) {
    const auto value = MetricsNumber(variant, column.pointer);
    row.emplace_back(value ? fmt::format("{:.{}f}", *value, column.decimals) : kNoValue);
  }
  return row;
}

}  // namespace

Table DatasetTable(const DatasetResult& dataset) {
  Table table = {"dataset_" + dataset.name, dataset.name, {"variant"}, {}, 1, {}};
  for (const Column& column : kColumns) table.header.emplace_back(column.title);
  for (const char* name : kPaperVariants) {
    const VariantResult* const variant = dataset.Evaluated(name);
    table.rows.push_back(RowOf(variant ? *variant : VariantResult{name, {}, {}, {}}));
  }
  std::set<std::string> odometry;
  for (const VariantResult& variant : dataset.variants) {
    const bool has_row = std::ranges::find(kPaperVariants, variant.name) != kPaperVariants.end();
    if (!has_row && !variant.metrics.is_null()) table.rows.push_back(RowOf(variant));
    const auto ate = MetricsNumber(variant, "/trajectory/odometry_ate_rmse_m");
    if (ate) odometry.insert(fmt::format("{:.4f} m", *ate));
  }
  // One value, unless variants started from different trajectories.
  if (!odometry.empty()) {
    table.notes.push_back(fmt::format("ATE of the odometry alone: {}", fmt::join(odometry, ", ")));
  }
  return table;
}

Table SequencesTable(const std::vector<DatasetResult>& datasets) {
  Table table = {
      "sequences",
      "Sequences",
      {"dataset", "boxes", "odometry", "annotation", "marks", "frames", "objects", "round"},
      {},
      5,
      {MarksNote(), "Objects are the annotated ones, with boxes or without."}};
  const auto text = [](const std::string& words) { return words.empty() ? kNoValue : words; };
  for (const DatasetResult& dataset : datasets) {
    const DatasetFacts& facts = dataset.facts;
    if (!facts.counts) continue;
    table.rows.push_back(
        {dataset.name, text(facts.boxes), text(facts.odometry), text(facts.annotation),
         MarksOf(facts, facts.counts->objects), std::to_string(facts.counts->frames),
         std::to_string(facts.counts->objects), std::to_string(facts.counts->round_objects)});
  }
  return table;
}

namespace {

using nlohmann::json;

// "2.31", or "2.31 to 2.34".
std::string Range(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  const std::string first = fmt::format("{:.4g}", least), last = fmt::format("{:.4g}", most);
  return first == last ? first : first + " to " + last;
}

// The residual distance (m) between camera centres after the alignments of a map: root mean square
// over the frames of all segments.
std::optional<double> ResidualOf(const json& alignments) {
  double squares = 0.0;
  int frames = 0;
  for (const json& alignment : alignments) {
    if (alignment.at("rmse_m").is_null()) continue;
    const int count = alignment.at("frames").get<int>();
    squares += count * std::pow(alignment.at("rmse_m").get<double>(), 2);
    frames += count;
  }
  return frames == 0 ? std::nullopt : std::optional(std::sqrt(squares / frames));
}

// "alignment similarity, scale 2.31 to 2.34, cameras 0.01 m from the true ones", for the maps of a
// dataset.
std::string AlignmentInWords(const std::vector<VariantResult>& maps) {
  std::set<std::string> kinds;
  std::vector<double> scales, residuals;
  for (const VariantResult& map : maps) {
    const json& alignments = map.metrics["map_quality"].at("alignments");
    for (const json& alignment : alignments) {
      kinds.insert(alignment.at("kind").get<std::string>());
      if (alignment.at("kind") == "similarity") scales.push_back(alignment.at("scale"));
    }
    if (const auto residual = ResidualOf(alignments)) residuals.push_back(*residual);
  }
  std::string text = fmt::format("alignment {}", fmt::join(kinds, " and "));
  if (!scales.empty()) text += ", scale " + Range(scales);
  if (!residuals.empty()) text += ", cameras " + Range(residuals) + " m from the true ones";
  return text;
}

std::vector<Cell> QualityRow(const std::string& name, const json& quality) {
  const json& first = quality.at("scores").front();
  std::vector<Cell> row = {name, FillIn("{true_objects} ({detectable})", first),
                           FillIn("{landmarks} ({ignored})", first),
                           FillIn("{recall_of_detectable:.2f}", first)};
  for (const json& score : quality.at("scores")) {
    for (const char* text :
         {"{found}", "{precision:.2f}", "{recall:.2f}", "{f1:.2f}", "{of_found/iou_mean:.3f}"}) {
      row.emplace_back(FillIn(text, score));
    }
  }
  return row;
}

std::vector<Cell> ErrorsRow(const std::string& name, const json& quality) {
  const json& first = quality.at("scores").front();
  std::vector<Cell> row = {name};
  for (const char* text :
       {"{centre_m_mean:.3f}", "{centre_relative_mean:.2f}",
        "{log_size_abs_mean/0:.2f}, {log_size_abs_mean/1:.2f}, {log_size_abs_mean/2:.2f}",
        "{log_scale_abs_mean:.3f}", "{yaw_error_deg_mean:.1f}", "{up_error_deg_mean:.1f}",
        "{plane_offset_m_abs_mean:.3f}", "{plane_tilt_deg_mean:.1f}"}) {
    row.emplace_back(FillIn(text, first.at("of_found")));
  }
  for (const char* text :
       {"{of_found/labels_agree} of {found}", "{of_found/ids_agree} of {of_found/ids_known}"}) {
    row.emplace_back(FillIn(text, first));
  }
  for (const char* text : {"{in_frames/iou_mean:.3f}", "{in_frames/iou_mean_in_world:.3f}"}) {
    row.emplace_back(FillIn(text, quality));
  }
  return row;
}

// Whose the pose estimates are.
std::string OdometryNote(const std::vector<VariantResult>& maps) {
  std::set<std::string> sources;
  for (const VariantResult& map : maps) sources.insert(map.metrics.value("odometry_source", ""));
  sources.erase("");
  return fmt::format("Odometry: {}.", sources.empty()
                                          ? "not said whose"
                                          : fmt::format("{}", fmt::join(sources, ", ")));
}

std::string KindOfAlignment(const VariantResult& map) {
  return map.metrics["map_quality"].at("alignments").front().at("kind");
}

void AddMistakes(const char* kind, const json& rows, const char* id, Table* table) {
  for (const json& row : rows) {
    if (row.at("reason").is_null()) continue;
    table->rows.push_back({kind, ObjectName(row, id), WithBlanks(row.at("reason")),
                           row.at("detail").get<std::string>()});
  }
}

}  // namespace

std::vector<Table> QualityTables(const DatasetResult& dataset) {
  std::vector<VariantResult> maps = dataset.variants;
  std::erase_if(maps, [](const auto& map) { return !map.metrics.contains("map_quality"); });
  if (maps.empty()) return {};
  Table quality;
  quality.name = "map_quality_" + dataset.name;
  quality.title = dataset.name + ": maps compared with all true objects, " + AlignmentInWords(maps);
  quality.header = {"variant", "true (det.)", "landmarks (ign.)", "R det."};
  for (const double min_iou : kMapIous) {
    for (const char* column : {"right", "P", "R", "F1", "IoU"}) {
      quality.header.push_back(fmt::format("{} {}", column, min_iou));
    }
  }
  Table errors;
  errors.name = "map_errors_" + dataset.name;
  errors.title = fmt::format("{}: errors of landmarks that are right at IoU {}, {}", dataset.name,
                             kMapIous.front(), AlignmentInWords(maps));
  errors.header = {"variant",   "centre m",        "centre / size", "log size x, y, z",
                   "log scale", "yaw of body deg", "up deg",        "plane m",
                   "plane deg", "labels",          "ids",           "IoU, frames",
                   "IoU, world"};
  const bool are_alike = std::ranges::all_of(maps, [&](const VariantResult& map) {
    return KindOfAlignment(map) == KindOfAlignment(maps.front());
  });
  for (const VariantResult& map : maps) {
    const std::string name =
        are_alike ? map.name : fmt::format("{} ({})", map.name, KindOfAlignment(map));
    quality.rows.push_back(QualityRow(name, map.metrics["map_quality"]));
    errors.rows.push_back(ErrorsRow(name, map.metrics["map_quality"]));
  }
  quality.notes = {
      "True objects (detectable ones), landmarks (ignored ones), recall of the detectable at IoU "
      "0.25. Landmarks that match a true object with an IoU of so much or more: how many are "
      "right, precision, recall, F1, mean IoU.",
      OdometryNote(maps)};
  errors.notes = {
      "Means of absolute values; logarithms are of estimate over truth. Yaw of body: modulo a "
      "quarter turn, as a body with permuted axes is the same. Labels and ids: how many agree. IoU "
      "in the frames that saw what is right or wrong in part, and of the same in the world."};
  return {quality, errors};
}

Table MistakesTable(const json& metrics) {
  Table table;
  table.name = "sentences";
  table.header = {"mistake", "object", "reason", "detail"};
  if (!metrics.contains("map_quality")) return table;
  AddMistakes("missed", metrics["map_quality"].at("objects"), "true_object", &table);
  AddMistakes("false", metrics["map_quality"].at("landmarks"), "object", &table);
  return table;
}

}  // namespace soslam
