// SPDX-License-Identifier: BSD-3-Clause
#include "report/dataset_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

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
constexpr const char* kOdometryAte = "/trajectory/odometry_ate_rmse_m";

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
    const bool has_row = std::find(kPaperVariants.begin(), kPaperVariants.end(), variant.name) !=
                         kPaperVariants.end();
    if (!has_row && !variant.metrics.is_null()) table.rows.push_back(RowOf(variant));
    const auto ate = MetricsNumber(variant, kOdometryAte);
    if (ate) odometry.insert(fmt::format("{:.4f} m", *ate));
  }
  // One value, unless variants started from different trajectories.
  if (!odometry.empty()) {
    table.notes.push_back(fmt::format("ATE of the odometry alone: {}", fmt::join(odometry, ", ")));
  }
  return table;
}

}  // namespace soslam
