// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>
#include <utility>

#include "base/text.h"
#include "inspection/inspection.h"
#include "report/page_html.h"
#include "report/tables.h"

namespace soslam {
namespace {

using nlohmann::json;

struct EvaluatedMap {
  std::string dataset;
  const VariantResult& variant;
  const json& quality;  // map_quality of its metrics
};

// The maps of these variants, by dataset.
std::vector<EvaluatedMap> MapsOf(const std::vector<DatasetResult>& datasets,
                                 const std::vector<std::string>& variants) {
  std::vector<EvaluatedMap> maps;
  for (const DatasetResult& dataset : datasets) {
    for (const std::string& name : variants) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (!variant || !variant->metrics.contains("map_quality")) continue;
      maps.push_back({dataset.name, *variant, variant->metrics["map_quality"]});
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
std::string SourceOf(const VariantResult& variant, const char* stage, const char* file) {
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

const std::vector<std::string> kWhatIfHeader = {"IoU in frames", "true yaw", "quarter turn",
                                                "true place", "true size"};
constexpr const char* kWhatIfNote =
    "IoU in the frames of the cameras, and what it would be with one thing of each landmark "
    "replaced by the true one. Yaw: of the object or of the body, whichever fits better. Quarter "
    "turn: the best of four about the landmark's own vertical axis.";

// The cells of kWhatIfHeader. `in_frames`: what has iou_mean and what_if, or null.
std::vector<Cell> WhatIfCells(const json& in_frames) {
  std::vector<Cell> cells;
  for (const char* text : {"{iou_mean:.3f}", "{what_if/yaw:.3f}", "{what_if/quarter_turn:.3f}",
                           "{what_if/place:.3f}", "{what_if/size:.3f}"}) {
    cells.emplace_back(in_frames.is_null() ? kNoValue : FillIn(text, in_frames));
  }
  return cells;
}

std::vector<Cell> LimitsRow(const json& landmark) {
  const json& errors = landmark.at("errors");
  std::vector<Cell> row = WhatIfCells(landmark.at("in_frames"));
  row.insert(row.begin(), {ObjectName(landmark, "true_object"), FillIn("{iou:.3f}", errors)});
  for (const char* text : {"{centre_m:.3f}", "{log_size/0:.2f}, {log_size/1:.2f}, {log_size/2:.2f}",
                           "{yaw_error_deg:.1f}"}) {
    row.emplace_back(FillIn(text, errors));
  }
  return row;
}

}  // namespace

Table MapsTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants) {
  Table table = {"maps", "Maps compared with all true objects", {}, {}, 4, {}};
  for (const EvaluatedMap& map : MapsOf(datasets, variants)) {
    const Table one = QualityTables({map.dataset, {map.variant}}).front();
    if (table.header.empty()) {
      table.header = {"dataset", "variant", "ids", "planes"};
      table.header.insert(table.header.end(), one.header.begin() + 1, one.header.end());
      table.notes = {one.notes.front()};
    }
    std::vector<Cell> row = WithMap(map, {SourceOf(map.variant, "associate", "associations.json"),
                                          SourceOf(map.variant, "planes", "planes.json")});
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
  for (const EvaluatedMap& map : MapsOf(datasets, variants)) {
    NamesByKey missed, false_ones;  // by reason
    std::set<json> missed_ids;
    for (const json& object : map.quality.at("objects")) {
      if (object.at("reason").is_null()) continue;
      missed[WithBlanks(object.at("reason"))].push_back(ObjectName(object, "true_object"));
      missed_ids.insert(object.at("true_object"));
    }
    for (const json& landmark : map.quality.at("landmarks")) {
      const bool is_of_missed = missed_ids.contains(landmark.at("true_object"));
      if (landmark.at("reason").is_null() || is_of_missed) continue;
      false_ones[WithBlanks(landmark.at("reason"))].push_back(ObjectName(landmark, "object"));
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
                 {"dataset", "variant", "object", "IoU"},
                 {},
                 3,
                 {kWhatIfNote,
                  "Logarithms are of estimate over truth, along the true axes. Yaw of body: modulo "
                  "a quarter turn."}};
  table.header.insert(table.header.end(), kWhatIfHeader.begin(), kWhatIfHeader.end());
  table.header.insert(table.header.end(), {"centre m", "log size x, y, z", "yaw of body deg"});
  for (const EvaluatedMap& map : MapsOf(datasets, variants)) {
    for (const json& landmark : map.quality.at("landmarks")) {
      if (landmark.at("fate") == "found") table.rows.push_back(WithMap(map, LimitsRow(landmark)));
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
  table.header.insert(table.header.end(), kWhatIfHeader.begin(), kWhatIfHeader.end());
  for (const DatasetResult& dataset : datasets) {
    for (const std::string& name : variants) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (!variant) continue;
      const bool is_map = variant->metrics.contains("map_quality");
      const json& in_frames =
          is_map ? variant->metrics["map_quality"].at("in_frames") : variant->metrics.at("summary");
      if (in_frames.at("what_if").is_null()) continue;
      std::vector<Cell> row = WhatIfCells(in_frames);
      row.insert(row.begin(), {dataset.name, variant->name,
                               FillIn(is_map ? "{landmarks}" : "{objects}", in_frames)});
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace soslam
