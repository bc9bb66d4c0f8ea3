// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "soslam/report/page_html.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

std::vector<Cell> MakeRow(const std::string& name, const Metrics& metrics) {
  const MetricsSummary& all = metrics.summary;
  const MetricsSummary first = metrics.first_observation.value_or(MetricsSummary());
  const auto mean = [](const ObjectMetric& metric, const MetricsSummary& summary) {
    return metric.Text(summary.*metric.mean);
  };
  return {name,
          std::to_string(all.objects),
          std::to_string(all.observations),
          mean(kIou, all),
          mean(kIou, first),
          mean(kRotation, all),
          mean(kRotation, first),
          mean(kYawError, all),
          metrics.trajectory ? kTrajectoryError.TextOf(*metrics.trajectory) : kNoValue};
}

// Adds a column for each metric of a part that rows may have, unless no row has it.
template <typename Metrics, typename Part>
void AddColumns(const Metrics& metrics, const std::vector<std::optional<Part>>& of_rows,
                Table* table) {
  if (std::ranges::none_of(of_rows, &std::optional<Part>::has_value)) return;
  for (const auto& metric : metrics) {
    table->header.push_back(metric.Header());
    for (size_t i = 0; i < of_rows.size(); ++i) {
      table->rows[i].emplace_back(of_rows[i] ? metric.TextOf(*of_rows[i]) : kNoValue);
    }
  }
}

}  // namespace

Table DatasetTable(const DatasetResult& dataset) {
  Table table = {"dataset_" + dataset.name, dataset.name, {}, {}, 1, {}};
  table.header = {"variant",
                  "objects",
                  "observations",
                  kIou.Header() + " (all)",
                  kIou.Header() + " (first)",
                  kRotation.Header() + " (all)",
                  kRotation.Header() + " (first)",
                  kYawError.Header(),
                  kTrajectoryError.Header()};
  std::vector<std::optional<FrontSummary>> fronts;
  for (const char* name : kPaperVariants) {
    const VariantResult* const variant = dataset.Evaluated(name);
    fronts.push_back(variant ? variant->metrics->summary.fronts : std::nullopt);
    std::vector<Cell> without(table.header.size(), kNoValue);
    without.front() = name;
    table.rows.push_back(variant ? MakeRow(name, *variant->metrics) : without);
  }
  std::set<std::string> odometry;
  for (const VariantResult& variant : dataset.variants) {
    if (!variant.metrics) continue;
    const bool has_row = std::ranges::find(kPaperVariants, variant.name) != kPaperVariants.end();
    if (!has_row) {
      table.rows.push_back(MakeRow(variant.name, *variant.metrics));
      fronts.push_back(variant.metrics->summary.fronts);
    }
    const auto& trajectory = variant.metrics->trajectory;
    if (!trajectory) continue;
    odometry.insert(fmt::format("{} {}", kTrajectoryError.Text(trajectory->odometry_ate_rmse_m),
                                kTrajectoryError.unit));
  }
  AddColumns(kFrontMetrics, fronts, &table);
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
         FormatMarks(facts, facts.counts->objects), std::to_string(facts.counts->frames),
         std::to_string(facts.counts->objects), std::to_string(facts.counts->round_objects)});
  }
  return table;
}

namespace {

// "2.31", or "2.31 to 2.34".
std::string Range(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  const std::string first = fmt::format("{:.4g}", least), last = fmt::format("{:.4g}", most);
  return first == last ? first : first + " to " + last;
}

// "alignment similarity, scale 2.31 to 2.34, cameras 0.01 m from the true ones", for the maps of a
// dataset. The distance is the root mean square over the frames of all segments of a map.
std::string AlignmentInWords(const std::vector<VariantResult>& maps) {
  std::set<std::string> kinds;
  std::vector<double> scales, residuals;
  for (const VariantResult& map : maps) {
    double squares = 0.0;
    int frames = 0;
    for (const auto& [segment, alignment] : map.metrics->map_quality->alignments.of_segment) {
      kinds.insert(NameOf(alignment.kind));
      if (alignment.kind == AlignmentKind::kSimilarity) scales.push_back(alignment.scale);
      if (!alignment.rmse_m) continue;
      squares += alignment.frames * std::pow(*alignment.rmse_m, 2);
      frames += alignment.frames;
    }
    if (frames > 0) residuals.push_back(std::sqrt(squares / frames));
  }
  std::string text = fmt::format("alignment {}", fmt::join(kinds, " and "));
  if (!scales.empty()) text += ", scale " + Range(scales);
  if (!residuals.empty()) text += ", cameras " + Range(residuals) + " m from the true ones";
  return text;
}

// The alignment of a map's first segment; none without segments.
std::optional<Alignment> FirstAlignment(const VariantResult& map) {
  const auto& of_segment = map.metrics->map_quality->alignments.of_segment;
  return of_segment.empty() ? std::nullopt : std::optional(of_segment.begin()->second);
}

std::string KindOfAlignment(const VariantResult& map) {
  const auto first = FirstAlignment(map);
  return first ? NameOf(first->kind) : kNoValue;
}

// Adds how up and scale of maps with a world of their own differ from the truth, by the first
// segment; nothing where no map has such a world.
void AddWorlds(const std::vector<VariantResult>& maps, Table* table) {
  std::vector<std::optional<Alignment>> worlds;
  for (const VariantResult& map : maps) {
    worlds.push_back(FirstAlignment(map).value_or(Alignment()));
  }
  const auto has_own_up = [](const auto& world) { return world->up_error_deg.has_value(); };
  if (std::ranges::none_of(worlds, has_own_up)) return;
  AddColumns(kWorldMetrics, worlds, table);
  table->notes.emplace_back(
      "Up of map: the angle between its up and the true one. True / map scale: what the map has to "
      "be multiplied by.");
}

std::vector<Cell> RowOfErrors(const std::string& name, const MapQuality& map) {
  const MapScore& score = map.scores.front();
  const FoundSummary& found = score.of_found;
  std::vector<Cell> row = {name};
  for (const auto& metric : kFoundMetrics) row.emplace_back(metric.TextOf(found));
  row.emplace_back(fmt::format("{} of {}", found.labels_agree, score.found));
  row.emplace_back(fmt::format("{} of {}", found.ids_agree, found.ids_known));
  for (const auto& metric : kDriftMetrics) row.emplace_back(metric.TextOf(map.in_frames));
  return row;
}

}  // namespace

std::vector<Table> QualityTables(const DatasetResult& dataset) {
  std::vector<VariantResult> maps = dataset.variants;
  std::erase_if(maps, [](const auto& map) { return !map.metrics || !map.metrics->map_quality; });
  if (maps.empty()) return {};
  Table quality, errors;
  quality.name = "map_quality_" + dataset.name;
  quality.title = dataset.name + ": maps compared with all true objects, " + AlignmentInWords(maps);
  quality.header = {"variant", "true (det.)", "landmarks (ign.)", kRecallOfDetectable.Header()};
  for (const double min_iou : kMapIous) {
    for (const auto& metric : kScoreMetrics) {
      quality.header.push_back(fmt::format("{} {}", metric.Header(), min_iou));
    }
  }
  errors.name = "map_errors_" + dataset.name;
  errors.title = fmt::format("{}: errors of landmarks that are right at IoU {}, {}", dataset.name,
                             kMapIous.front(), AlignmentInWords(maps));
  errors.header = {"variant"};
  for (const auto& metric : kFoundMetrics) errors.header.push_back(metric.Header());
  errors.header.insert(errors.header.end(), {"labels", "ids"});
  for (const auto& metric : kDriftMetrics) errors.header.push_back(metric.Header());
  const bool are_alike = std::ranges::all_of(maps, [&](const VariantResult& map) {
    return KindOfAlignment(map) == KindOfAlignment(maps.front());
  });
  std::vector<std::optional<FrontSummary>> fronts;
  std::set<std::string> odometry_sources;
  for (const VariantResult& map : maps) {
    const std::string name =
        are_alike ? map.name : fmt::format("{} ({})", map.name, KindOfAlignment(map));
    const MapQuality& of_map = *map.metrics->map_quality;
    const MapScore& first = of_map.scores.front();
    std::vector<Cell> row = {name, fmt::format("{} ({})", first.true_objects, first.detectable),
                             fmt::format("{} ({})", first.landmarks, first.ignored),
                             kRecallOfDetectable.TextOf(first)};
    for (const MapScore& score : of_map.scores) {
      for (const auto& metric : kScoreMetrics) row.emplace_back(metric.TextOf(score));
    }
    quality.rows.push_back(row);
    errors.rows.push_back(RowOfErrors(name, of_map));
    fronts.push_back(first.of_found.fronts);
    odometry_sources.insert(map.metrics->odometry_source);
  }
  AddColumns(kFrontMetrics, fronts, &errors);
  odometry_sources.erase("");
  quality.notes = {
      "True objects (detectable ones), landmarks (ignored ones), recall of the detectable at IoU "
      "0.25. Landmarks that match a true object with an IoU of so much or more: how many are "
      "right, precision, recall, F1, average precision, mean IoU.",
      odometry_sources.empty() ? "Odometry: not said whose."
                               : fmt::format("Odometry: {}.", fmt::join(odometry_sources, ", "))};
  errors.notes = {
      "Means of absolute values; logarithms are of estimate over truth. Yaw of body: modulo a "
      "quarter turn, as a body with permuted axes is the same. Labels and ids: how many agree. IoU "
      "in the frames that saw what is right or wrong in part, and of the same in the world."};
  AddWorlds(maps, &errors);
  return {quality, errors};
}

Table MistakesTable(const Metrics& metrics) {
  Table table;
  table.name = "sentences";
  table.header = {"mistake", "object", "reason", "detail"};
  if (!metrics.map_quality) return table;
  const auto add = [&](const char* mistake, const std::string& object,
                       const std::optional<Explanation>& why) {
    if (why) table.rows.push_back({mistake, object, WithBlanks(NameOf(why->reason)), why->detail});
  };
  for (const TrueObjectRow& row : metrics.map_quality->objects) {
    add("missed", ObjectName(row.label, row.true_index), row.miss);
  }
  for (const LandmarkRow& row : metrics.map_quality->landmarks) {
    add("false", ObjectName(row.label, row.object_index), row.why_false);
  }
  return table;
}

}  // namespace soslam
