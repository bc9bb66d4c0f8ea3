// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "artefact/atomic_file.h"
#include "base/error.h"
#include "base/table.h"
#include "report/dataset_tables.h"
#include "report/paired_differences.h"
#include "report/paper_tables.h"
#include "report/results_tree.h"
#include "report/timing_table.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::vector<DatasetResult> ReadEvaluated(const fs::path& results) {
  std::vector<DatasetResult> datasets = ReadResults(results);
  std::erase_if(datasets, [](const DatasetResult& dataset) {
    return std::all_of(dataset.variants.begin(), dataset.variants.end(),
                       [](const VariantResult& variant) { return variant.metrics.is_null(); });
  });
  if (datasets.empty()) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/<variant>/metrics.json; expected at least one");
  }
  return datasets;
}

// Writes the Markdown file and, in the folder "tables" beside it, each table as CSV and LaTeX.
// Returns the Markdown.
std::string WriteTables(const std::vector<Table>& tables, const fs::path& markdown_file) {
  const fs::path folder = markdown_file.parent_path() / "tables";
  std::error_code error;  // a missing folder fails on writing below
  fs::create_directory(folder, error);
  std::string text;
  for (const Table& table : tables) {
    text += (text.empty() ? "" : "\n") + ToMarkdown(table);
    WriteTextFile(folder / (table.name + ".csv"), ToCsv(table));
    WriteTextFile(folder / (table.name + ".tex"), ToLatex(table));
  }
  WriteTextFile(markdown_file, text);
  return text;
}

// All tables in the order of the report: the paper's tables, paired differences, single datasets.
std::vector<Table> AllTables(const std::vector<DatasetResult>& datasets, const Published& published,
                             const std::vector<Comparison>& comparisons) {
  std::vector<Table> tables = PaperTables(datasets, published);
  tables.push_back(TimeTable(datasets, published));
  tables.push_back(StageTimeTable(datasets));
  for (const Quantity& quantity : {kIou, kRotation, kYawError}) {
    tables.push_back(DifferencesTable(datasets, comparisons, quantity));
  }
  for (const DatasetResult& dataset : datasets) {
    tables.push_back(DatasetTable(dataset));
    std::ranges::move(QualityTables(dataset), std::back_inserter(tables));
  }
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace

void RunReport(const ReportOptions& options, const StageFiles& files, int /*threads*/) {
  const std::vector<Comparison> comparisons = ParseComparisons(options.compare);
  const Published published =
      files.contains("published") ? ReadPublished(files.at("published")) : Published();
  const std::vector<DatasetResult> datasets = ReadEvaluated(files.at("results"));
  fmt::print("{}", WriteTables(AllTables(datasets, published, comparisons), files.at("output")));
}

}  // namespace soslam
