// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "base/text.h"
#include "report/page_html.h"
#include "report/tables.h"

namespace soslam {
namespace {

using nlohmann::json;

// Calls `visit` for each map of these variants, by dataset.
void ForEachMap(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants,
                const std::function<void(const DatasetResult&, const VariantResult&)>& visit) {
  for (const DatasetResult& dataset : datasets) {
    for (const std::string& name : variants) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (variant && variant->metrics.contains("map_quality")) visit(dataset, *variant);
    }
  }
}

std::vector<Cell> WithMap(const DatasetResult& dataset, const VariantResult& variant,
                          const std::vector<Cell>& cells) {
  std::vector<Cell> row = {dataset.name, variant.name};
  row.insert(row.end(), cells.begin(), cells.end());
  return row;
}

// Who says it: the dataset, or a stage, which writes this file.
std::string SourceOf(const VariantResult& variant, const char* stage, const char* file) {
  return ShowsStage(variant, stage, file) ? "estimated" : "given";
}

// True for a false landmark that is the landmark of an object in `missed`.
bool IsOfMissed(const json& landmark, const std::set<int>& missed) {
  const json& object = landmark.at("true_object");
  return !object.is_null() && missed.contains(object.get<int>());
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

std::vector<Cell> LimitsRow(const json& landmark) {
  const json& errors = landmark.at("errors");
  const json& wrong = landmark.at("wrong_part");
  return {ObjectName(landmark, "true_object"),
          wrong.is_null() ? kNoValue : WithBlanks(wrong.at("part")),
          NumberText(errors.at("iou"), 3),
          wrong.is_null() ? kNoValue : NumberText(wrong.at("iou_corrected"), 3),
          NumberText(errors.at("centre_m"), 3),
          fmt::format("{}, {}, {}", NumberText(errors.at("log_size").at(0), 2),
                      NumberText(errors.at("log_size").at(1), 2),
                      NumberText(errors.at("log_size").at(2), 2)),
          NumberText(errors.at("yaw_error_deg"), 1)};
}

}  // namespace

Table MapsTable(const std::vector<DatasetResult>& datasets,
                const std::vector<std::string>& variants) {
  Table table = {"maps", "Maps against all that is true", {}, {}, 4, {}};
  ForEachMap(datasets, variants, [&](const DatasetResult& dataset, const VariantResult& variant) {
    const Table one = QualityTables({dataset.name, {variant}}).front();
    if (table.header.empty()) {
      table.header = {"dataset", "variant", "ids", "planes"};
      table.header.insert(table.header.end(), one.header.begin() + 1, one.header.end());
      table.notes = {one.notes.front()};
    }
    std::vector<Cell> row = WithMap(dataset, variant,
                                    {SourceOf(variant, "associate", "associations.json"),
                                     SourceOf(variant, "planes", "planes.json")});
    row.insert(row.end(), one.rows.front().begin() + 1, one.rows.front().end());
    table.rows.push_back(std::move(row));
  });
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
      {"At IoU 0.25, with their ids, those of false landmarks in the map. The landmark of "
       "a missed object is not listed again. soslam-inspect metrics.json says more of "
       "each."}};
  ForEachMap(datasets, variants, [&](const DatasetResult& dataset, const VariantResult& variant) {
    const json& quality = variant.metrics["map_quality"];
    NamesByKey missed, false_ones;  // by reason
    std::set<int> missed_ids;
    for (const json& object : quality.at("objects")) {
      if (object.at("reason").is_null()) continue;
      missed[WithBlanks(object.at("reason"))].push_back(ObjectName(object, "true_object"));
      missed_ids.insert(object.at("true_object").get<int>());
    }
    for (const json& landmark : quality.at("landmarks")) {
      if (landmark.at("reason").is_null() || IsOfMissed(landmark, missed_ids)) continue;
      false_ones[WithBlanks(landmark.at("reason"))].push_back(ObjectName(landmark, "object"));
    }
    const auto add_rows = [&](const char* mistake, const NamesByKey& names) {
      for (const auto& [reason, objects] : names) {
        AddOrJoin(WithMap(dataset, variant, {mistake, reason, NamesInWords(objects, kNamesInCell)}),
                  &table);
      }
    };
    add_rows("missed", missed);
    add_rows("false", false_ones);
  });
  return table;
}

Table LimitsTable(const std::vector<DatasetResult>& datasets,
                  const std::vector<std::string>& variants) {
  Table table = {"limits",
                 "What limits the found objects",
                 {"dataset", "variant", "object", "part", "IoU", "corrected", "centre m",
                  "log size x, y, z", "yaw deg"},
                 {},
                 4,
                 {"The part of the landmark (plane, size, yaw, place) that gains most if it is "
                  "replaced by the true one, and the IoU then. Logarithms are of estimate over "
                  "truth, along the true axes."}};
  ForEachMap(datasets, variants, [&](const DatasetResult& dataset, const VariantResult& variant) {
    for (const json& landmark : variant.metrics["map_quality"].at("landmarks")) {
      if (landmark.at("fate") != "found") continue;
      table.rows.push_back(WithMap(dataset, variant, LimitsRow(landmark)));
    }
  });
  return table;
}

}  // namespace soslam
