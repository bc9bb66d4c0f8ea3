// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/table.h"
#include "soslam/dataset/image_path.h"
#include "soslam/report/page.h"
#include "soslam/report/page_html.h"
#include "soslam/report/results_tree.h"
#include "soslam/report/tables.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {

namespace fs = std::filesystem;

void RunReport(const ReportOptions& options, const StageFiles& files, int /*threads*/) {
  const std::vector<Comparison> comparisons = ParseComparisons(options.compare);
  const Published published =
      files.contains("published") ? ReadPublished(files.at("published")) : Published();
  const fs::path& results = files.at("results");
  const fs::path settings = files.contains("datasets") ? files.at("datasets") : fs::path();
  std::vector<DatasetResult> datasets = ReadResults(results);
  std::erase_if(datasets, [](const DatasetResult& dataset) {
    return std::ranges::all_of(dataset.variants,
                               [](const VariantResult& variant) { return !variant.metrics; });
  });
  if (datasets.empty()) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/<variant>/metrics.json; expected at least one");
  }
  for (DatasetResult& dataset : datasets) dataset.facts = ReadFacts(dataset, settings);
  const std::vector<std::string> maps = SplitAtSpaces(options.maps);
  // The paper's tables, paired differences, maps, single datasets.
  std::vector<Table> tables = {SequencesTable(datasets)};
  std::ranges::move(PaperTables(datasets, published), std::back_inserter(tables));
  tables.push_back(TimeTable(datasets, published));
  tables.push_back(DifferencesOverDatasets(datasets, comparisons));
  for (const ObjectMetric& metric : kMeanMetrics) {
    tables.push_back(DifferencesTable(datasets, comparisons, metric));
  }
  tables.push_back(MapsTable(datasets, maps));
  tables.push_back(LostTable(datasets, maps));
  tables.push_back(LimitsTable(datasets, maps));
  tables.push_back(WhatIfTable(datasets, SplitAtSpaces(options.what_if)));
  for (const DatasetResult& dataset : datasets) {
    tables.push_back(DatasetTable(dataset));
    std::ranges::move(QualityTables(dataset), std::back_inserter(tables));
  }
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  const fs::path folder = files.at("output").parent_path() / "tables";
  std::error_code error;  // a missing folder fails on writing below
  fs::create_directory(folder, error);
  std::string markdown;
  for (const Table& table : tables) {
    markdown += (markdown.empty() ? "" : "\n") + ToMarkdown(table);
    WriteTextFile(folder / (table.name + ".csv"), ToCsv(table));
    WriteTextFile(folder / (table.name + ".tex"), ToLatex(table));
  }
  WriteTextFile(files.at("output"), markdown);
  fmt::print("{}", markdown);
  if (!files.contains("page")) return;
  // Not recorded as an input: the report writes it anew.
  const fs::path& page = files.at("page");
  std::ifstream stream(page, std::ios::binary);
  if (!stream) throw InputError(page.string() + ": cannot be read; expected a page with tables");
  const std::string unfilled{std::istreambuf_iterator<char>(stream), {}};
  WriteTextFile(page, FillPage(unfilled, tables, page.string()));
}

namespace {

// Images of a dataset folder; frames whose file is missing have no image.
ImageSource ImagesIn(const fs::path& dataset, const Sequence& sequence) {
  const auto frame_at = [&sequence](int frame_index) -> const Frame& {
    return sequence.frames[frame_index];
  };
  const auto reader = std::make_shared<const FrameImageReader>(sequence);
  return {[=](int frame_index) {
            const std::string& image = frame_at(frame_index).image;
            return !image.empty() && Exists(dataset / image);
          },
          [=](int frame_index) {
            const Frame& frame = frame_at(frame_index);
            const std::string place = fmt::format("frame {}", frame.id);
            return reader->Read({&frame, ImagePath(dataset, frame.image, place)}, cv::IMREAD_COLOR);
          }};
}

}  // namespace

void RunPages(const NoOptions& /*options*/, const StageFiles& files, int threads) {
  const fs::path& results = files.at("results");
  if (!IsFolder(results)) {
    throw InputError(results.string() + ": is no folder; expected results of runs");
  }
  std::vector<DatasetPage> pages;
  for (const DatasetResult& result : ReadResults(results, DamagedFiles::kNoted)) {
    const auto page_with = [&](const std::string& tables, const nlohmann::json& data) {
      return PageHtml(result.name, tables, data, PageScripts::kDataset);
    };
    const fs::path folder = results / result.name;
    const size_t max_data_bytes = kMaxPageBytes - page_with("", {}).size();
    const fs::path dataset = ReadDatasetFolder(folder);
    DatasetPage& page = pages.emplace_back(MakePage(
        result, [&](const Sequence& sequence) { return ImagesIn(dataset, sequence); },
        max_data_bytes, threads));
    const auto print = [&](const std::string& problem) {
      fmt::print(stderr, "soslam-pages: {}: {}\n", result.name, problem);
    };
    for (const UnfinishedVariant& variant : page.unfinished) {
      print(variant.name + " " + variant.state);
    }
    for (const std::string& problem : page.problems) print(problem);
    if (page.variants.empty()) continue;  // there is nothing to show
    const std::string html = page_with(DatasetTables(page), MakePageData(page));
    WriteTextFile(folder / "report.html", html);
    fmt::print("{}: {} variants, {} images, {:.1f} MB\n", (folder / "report.html").string(),
               page.variants.size(), page.images.size(), static_cast<double>(html.size()) / 1e6);
    page.images.clear();
  }
  const bool shows_something =
      std::ranges::any_of(pages, [](const DatasetPage& page) { return !page.variants.empty(); });
  if (!shows_something) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/<variant>/ with a metrics.json and what it is of that "
                             "can be read; expected at least one");
  }
  WriteTextFile(results / "report.html", PageHtml("Results", OverviewTables(pages),
                                                  OverviewData(pages), PageScripts::kNone));
}

}  // namespace soslam
