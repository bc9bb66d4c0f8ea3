// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "artefact/atomic_file.h"
#include "artefact/json_file.h"
#include "base/error.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The methods that the paper compares, in its order.
constexpr std::array kPaperVariants = {"SVD",     "Init1-1", "InitP", "InitPT",
                                       "Quadric", "OursP",   "OursPT"};
// Those that this project adds: the same steps for bodies of any shape.
constexpr std::array kShapeVariants = {"MultiView", "InitS",  "InitST", "InitSTE",
                                       "OursS",     "OursST", "OursSTE"};

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

struct VariantMetrics {
  std::string name;
  std::string file;
  json metrics;  // null when there are none
};

using Row = std::vector<std::string>;

std::vector<std::string> SubfoldersOf(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The variants of a dataset in the order of the table: the paper's, also those without metrics,
// then ours and any others that have some. Empty when none has metrics.
std::vector<VariantMetrics> ReadVariants(const fs::path& dataset) {
  std::vector<std::string> names(kPaperVariants.begin(), kPaperVariants.end());
  const auto add = [&](const std::string& name) {
    const bool is_listed = std::find(names.begin(), names.end(), name) != names.end();
    if (!is_listed && fs::exists(dataset / name / "metrics.json")) names.push_back(name);
  };
  std::for_each(kShapeVariants.begin(), kShapeVariants.end(), add);
  for (const std::string& name : SubfoldersOf(dataset)) add(name);
  std::vector<VariantMetrics> variants;
  bool any = false;
  for (const std::string& name : names) {
    const fs::path file = dataset / name / "metrics.json";
    const bool exists = fs::exists(file);
    variants.push_back({name, file.string(), exists ? ReadArtefact(file, "metrics") : json()});
    any = any || exists;
  }
  return any ? variants : std::vector<VariantMetrics>();
}

// A number of a metrics file as text; "-" when it is null or absent.
std::string Cell(const VariantMetrics& variant, const std::string& pointer, int decimals) {
  const json::json_pointer place(pointer);
  if (!variant.metrics.contains(place) || variant.metrics.at(place).is_null()) return "-";
  const json& value = variant.metrics.at(place);
  if (!value.is_number()) {
    throw InputError(fmt::format("{}: {} is {}; expected a number or null", variant.file, pointer,
                                 value.dump()));
  }
  return fmt::format("{:.{}f}", value.get<double>(), decimals);
}

Row RowOf(const VariantMetrics& variant) {
  Row row = {variant.name};
  for (const Column& column : kColumns) {
    row.push_back(Cell(variant, column.pointer, column.decimals));
  }
  return row;
}

// A Markdown table with padded columns: the first one left-aligned, the others right-aligned.
std::string FormatTable(const std::vector<Row>& rows) {
  std::vector<size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto format_row = [&](const Row& row) {
    std::string line = fmt::format("| {:<{}} |", row[0], widths[0]);
    for (size_t i = 1; i < row.size(); ++i) line += fmt::format(" {:>{}} |", row[i], widths[i]);
    return line + "\n";
  };
  std::string text = format_row(rows.front());
  text += fmt::format("|{:-<{}}|", "", widths[0] + 2);
  for (size_t i = 1; i < widths.size(); ++i) text += fmt::format("{:->{}}:|", "", widths[i] + 1);
  text += "\n";
  for (size_t i = 1; i < rows.size(); ++i) text += format_row(rows[i]);
  return text;
}

std::string FormatDataset(const std::string& name, const std::vector<VariantMetrics>& variants) {
  std::vector<Row> rows = {{"variant"}};
  for (const Column& column : kColumns) rows.front().emplace_back(column.title);
  std::set<std::string> odometry;
  for (const VariantMetrics& variant : variants) {
    rows.push_back(RowOf(variant));
    const std::string ate = Cell(variant, kOdometryAte, 4);
    if (ate != "-") odometry.insert(ate);
  }
  std::string text = fmt::format("## {}\n\n{}", name, FormatTable(rows));
  // One value, unless variants were given different trajectories.
  if (!odometry.empty()) {
    text += fmt::format("\nATE of the odometry alone: {} m\n", fmt::join(odometry, " m, "));
  }
  return text;
}

}  // namespace

void RunReport(const ReportOptions& /*options*/, const StageFiles& files, int /*threads*/) {
  const fs::path& results = files.at("results");
  std::string text;
  for (const std::string& dataset : SubfoldersOf(results)) {
    const std::vector<VariantMetrics> variants = ReadVariants(results / dataset);
    if (variants.empty()) continue;
    if (!text.empty()) text += "\n";
    text += FormatDataset(dataset, variants);
  }
  if (text.empty()) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/<variant>/metrics.json; expected at least one");
  }
  WriteTextFile(files.at("output"), text);
  fmt::print("{}", text);
}

}  // namespace soslam
