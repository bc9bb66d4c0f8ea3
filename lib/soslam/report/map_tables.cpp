// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "soslam/base/text.h"
#include "soslam/report/page_html.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

struct EvaluatedMap {
  std::string dataset;
  const VariantResult& variant;
  const MapQuality& quality;  // that of its metrics
};

// The maps of these variants, by dataset.
std::vector<EvaluatedMap> FindMaps(const std::vector<DatasetResult>& datasets,
                                   const std::vector<std::string>& variants) {
  std::vector<EvaluatedMap> maps;
  for (const DatasetResult& dataset : datasets) {
    for (const std::string& name : variants) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (!variant || !variant->metrics->map_quality) continue;
      maps.push_back({dataset.name, *variant, *variant->metrics->map_quality});
    }
  }
  return maps;
}

std::vector<Cell> WithMap(const EvaluatedMap& map, const std::vector<Cell>& cells) {
  std::vector<Cell> row = {map.dataset, map.variant.name};
  row.insert(row.end(), cells.begin(), cells.end());
  return row;
}

// Who says it: the dataset, or a stage, which writes this file.
std::string NameSource(const VariantResult& variant, const char* stage, const char* file) {
  return ShowsStage(variant, stage, file) ? "estimated" : "given";
}

constexpr size_t kNamesInCell = 12;

// Adds a row, or its variant to a row that says the same of another variant.
void AddOrJoin(const std::vector<Cell>& row, Table* table) {
  constexpr size_t kVariant = 1;
  const auto says_the_same = [&](const std::vector<Cell>& other) {
    for (size_t i = 0; i < row.size(); ++i) {
      if (i != kVariant && other[i].text != row[i].text) return false;
    }
    return true;
  };
  const auto other = std::ranges::find_if(table->rows, says_the_same);
  if (other == table->rows.end()) {
    table->rows.push_back(row);
  } else {
    (*other)[kVariant].text += ", " + row[kVariant].text;
  }
}

constexpr const char* kWhatIfNote =
    "IoU in the frames of the cameras, and what it would be with one thing of each landmark "
    "replaced by the true one. Yaw: of the object or of the body, whichever fits better. Quarter "
    "turn: the best of four about the landmark's own vertical axis.";

void AddWhatIfHeader(Table* table) {
  table->header.emplace_back(kIouInFrames.Header());
  for (const auto& metric : kWhatIfMetrics) table->header.push_back(metric.Header());
}

void AddWhatIfCells(const MetricValues& iou, const std::optional<WhatIf>& what_if,
                    std::vector<Cell>* row) {
  row->emplace_back(kIouInFrames.Text(iou));
  for (const auto& metric : kWhatIfMetrics) {
    row->emplace_back(what_if ? metric.TextOf(*what_if) : kNoValue);
  }
}

}  // namespace

Table MapsTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants) {
  Table table = {"maps", "Maps compared with all true objects", {}, {}, 4, {}};
  for (const EvaluatedMap& map : FindMaps(datasets, variants)) {
    const Table one = QualityTables({map.dataset, {map.variant}}).front();
    if (table.header.empty()) {
      table.header = {"dataset", "variant", "ids", "planes"};
      table.header.insert(table.header.end(), one.header.begin() + 1, one.header.end());
      table.notes = {one.notes.front()};
    }
    std::vector<Cell> row = WithMap(map, {NameSource(map.variant, "associate", "associations.json"),
                                          NameSource(map.variant, "planes", "planes.json")});
    row.insert(row.end(), one.rows.front().begin() + 1, one.rows.front().end());
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table LostTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants) {
  Table table = {
      "lost",
      "Missed objects and false landmarks",
      {"dataset", "variant", "mistake", "reason", "objects"},
      {},
      5,
      {"At IoU 0.25, with their ids, those of false landmarks in the map. The landmark of a missed "
       "object is not listed again. soslam-inspect metrics.json says more of each."}};
  for (const EvaluatedMap& map : FindMaps(datasets, variants)) {
    NamesByKey missed, false_ones;  // by reason
    std::set<std::optional<int>> missed_ids;
    for (const TrueObjectRow& row : map.quality.objects) {
      if (!row.miss) continue;
      missed[WithBlanks(NameOf(row.miss->reason))].push_back(ObjectName(row.label, row.true_index));
      missed_ids.insert(row.true_index);
    }
    for (const LandmarkRow& row : map.quality.landmarks) {
      if (!row.why_false || missed_ids.contains(row.true_index)) continue;
      false_ones[WithBlanks(NameOf(row.why_false->reason))].push_back(
          ObjectName(row.label, row.object_index));
    }
    const auto add_rows = [&](const char* mistake, const NamesByKey& names) {
      for (const auto& [reason, objects] : names) {
        AddOrJoin(WithMap(map, {mistake, reason, NamesInWords(objects, kNamesInCell)}), &table);
      }
    };
    add_rows("missed", missed);
    add_rows("false", false_ones);
  }
  return table;
}

Table LimitsTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants) {
  Table table = {"limits",
                 "What limits the found objects",
                 {"dataset", "variant", "object", kBodyIou.Header()},
                 {},
                 3,
                 {kWhatIfNote,
                  "Logarithms are of estimate over truth, along the true axes. Yaw of body: modulo "
                  "a quarter turn."}};
  AddWhatIfHeader(&table);
  for (const auto& metric : kBodyMetrics) table.header.push_back(metric.Header());
  for (const EvaluatedMap& map : FindMaps(datasets, variants)) {
    for (const LandmarkRow& landmark : map.quality.landmarks) {
      if (landmark.fate != LandmarkFate::kFound || !landmark.errors) continue;
      std::vector<Cell> row = {ObjectName(landmark.label, landmark.true_index.value_or(0)),
                               kBodyIou.TextOf(*landmark.errors)};
      const auto& in_frames = landmark.in_frames;
      AddWhatIfCells(in_frames ? kIouInFrames.of(*in_frames) : MetricValues{std::nullopt},
                     in_frames ? std::optional(in_frames->what_if) : std::nullopt, &row);
      for (const auto& metric : kBodyMetrics) row.emplace_back(metric.TextOf(*landmark.errors));
      table.rows.push_back(WithMap(map, row));
    }
  }
  return table;
}

Table WhatIfTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants) {
  Table table = {"what_if",
                 "With one thing replaced by the truth",
                 {"dataset", "variant", "landmarks"},
                 {},
                 2,
                 {kWhatIfNote, "Single frames: means over the observations of each object first."}};
  AddWhatIfHeader(&table);
  for (const DatasetResult& dataset : datasets) {
    for (const std::string& name : variants) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (!variant) continue;
      const MetricsSummary& summary = variant->metrics->summary;
      const auto& quality = variant->metrics->map_quality;
      const auto& what_if = quality ? quality->in_frames.what_if : summary.what_if;
      if (!what_if) continue;
      std::vector<Cell> row = {
          dataset.name, variant->name,
          std::to_string(quality ? quality->in_frames.landmarks : summary.objects)};
      AddWhatIfCells(quality ? kDriftIou.of(quality->in_frames) : MetricValues{summary.*kIou.mean},
                     what_if, &row);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace soslam
