// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "soslam/artefact/json_file.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/report/tables.h"

namespace soslam {

const PublishedTable* Published::Find(const std::string& number, const Metric& metric) const {
  const auto found = std::ranges::find_if(tables, [&](const PublishedTable& table) {
    return table.table == number && table.quantity == metric.Key();
  });
  return found == tables.end() ? nullptr : &*found;
}

Published ReadPublished(const std::filesystem::path& path) {
  return ReadDocument<Published>(ParseJsonFile(path), path.string());
}

namespace {

// A kind of rows of measured values.
struct RowKind {
  const char* title;
  bool is_of_first_observation = false;
};

struct Layout {
  const char* number;
  const char* name;
  const char* title;
  ObjectMetric metric;
  std::vector<std::string> variants;  // columns; one that is not ours has published values only
  std::vector<RowKind> row_kinds;
};

constexpr const char* kBoldNote =
    "Bold: the best measured value of a row, if over all of its objects. Values over fewer objects "
    "have their number in brackets. Where variants have different observations, the most are "
    "given, with the first variant that has them in brackets.";

const std::vector<std::string> kInitialVariants = {"SVD",     "Cube",      "Init1-1", "InitP",
                                                   "InitPT",  "MultiView", "InitS",   "InitST",
                                                   "InitSTE", "InitSP",    "InitSTEP"};
const std::vector<std::string> kMapVariants = {"Quadric", "OursP",   "OursPT", "OursS",
                                               "OursST",  "OursSTE", "OursSP", "OursSTEP"};
const std::vector<RowKind> kSingleFrameRows = {{"all observations"}, {"first observation", true}};
const std::vector<RowKind> kMapRows = {{"measured"}};

const std::vector<Layout> kLayouts = {
    {"I", "table_1_initial_iou", "Initialisation, IoU", kIou, kInitialVariants, kSingleFrameRows},
    {"II", "table_2_initial_rotation", "Initialisation, Rot (degrees)", kRotation, kInitialVariants,
     kSingleFrameRows},
    {"III", "table_3_map_iou", "Map, IoU", kIou, kMapVariants, kMapRows},
    {"IV", "table_4_map_rotation", "Map, Rot (degrees)", kRotation, kMapVariants, kMapRows}};

// One mean per column.
using Means = std::vector<std::optional<ObjectMean>>;

auto CountMeans(const Means& means) {
  return std::ranges::count_if(means, [](const auto& mean) { return mean.has_value(); });
}

// Empty for variants without the metric. Only single-frame variants have first observations; their
// number of objects is that over all observations, as metrics.json has no other.
Means CollectMeans(const DatasetResult& dataset, const Layout& layout, const RowKind& kind) {
  Means means(layout.variants.size());
  for (size_t i = 0; i < means.size(); ++i) {
    const VariantResult* const variant = dataset.Evaluated(layout.variants[i]);
    if (!variant) continue;
    const auto& summary = kind.is_of_first_observation ? variant->metrics->first_observation
                                                       : std::optional(variant->metrics->summary);
    const int objects = static_cast<int>(ObjectValues(*variant, layout.metric).size());
    if (!summary || objects == 0) continue;
    const std::optional<double> mean = (*summary).*layout.metric.mean;
    if (mean) means[i] = {*mean, objects, summary->observations};
  }
  return means;
}

std::vector<Cell> MeasuredRow(const std::string& dataset, const std::string& kind,
                              const Means& means, const Layout& layout,
                              const DatasetFacts& facts = {}) {
  int objects = 0;
  std::optional<double> best;
  for (const auto& mean : means) {
    if (!mean) continue;
    objects = std::max(objects, mean->objects);
    if (!best || layout.metric.IsBetter(mean->mean, *best)) best = mean->mean;
  }
  const auto observations_of = [](const auto& mean) { return mean ? mean->observations : 0; };
  const auto with_most = std::ranges::max_element(means, {}, observations_of);
  const int observations = observations_of(*with_most);
  std::string most = observations == 0 ? kNoValue : std::to_string(observations);
  const bool are_equal = std::ranges::all_of(
      means, [&](const auto& mean) { return !mean || mean->observations == observations; });
  if (!are_equal) most += fmt::format(" ({})", layout.variants[with_most - means.begin()]);
  std::vector<Cell> row = {dataset, kind, FormatMarks(facts, objects), std::to_string(objects),
                           most};
  for (const auto& mean : means) {
    const std::string text = mean ? layout.metric.Text(mean->mean) : kNoValue;
    if (mean && mean->objects < objects) {
      row.emplace_back(fmt::format("{} ({})", text, mean->objects));
    } else {
      // Values that look equal are equally good.
      row.emplace_back(text, mean && text == layout.metric.Text(best));
    }
  }
  return row;
}

std::vector<Cell> MakePublishedRow(const PublishedRow& published, const Layout& layout) {
  std::vector<Cell> row = {published.dataset, "published", kNoValue,
                           std::to_string(published.objects), kNoValue};
  for (const std::string& variant : layout.variants) {
    const auto value = published.values.find(variant);
    row.emplace_back(value == published.values.end() ? kNoValue
                                                     : layout.metric.Text(value->second));
  }
  return row;
}

// The published dataset that this one stands above.
std::string FindPublishedName(const DatasetResult& dataset) {
  return dataset.facts.published.empty() ? dataset.name : dataset.facts.published;
}

// One row per dataset and kind, followed by the published values of the dataset: first the
// published datasets in their order, then the others.
void AddDatasetRows(const std::vector<DatasetResult>& datasets, const PublishedTable* published,
                    const Layout& layout, Table* table) {
  const auto add_measured = [&](const DatasetResult& dataset) {
    const size_t rows = table->rows.size();
    for (const RowKind& kind : layout.row_kinds) {
      const Means means = CollectMeans(dataset, layout, kind);
      if (CountMeans(means) == 0) continue;
      table->rows.push_back(MeasuredRow(dataset.name, kind.title, means, layout, dataset.facts));
    }
    return table->rows.size() > rows;
  };
  std::vector<std::string> differences;
  std::vector<PublishedRow> published_rows;
  if (published) published_rows = published->rows;
  for (const PublishedRow& row : published_rows) {
    for (const DatasetResult& dataset : datasets) {
      if (FindPublishedName(dataset) != row.dataset || !add_measured(dataset)) continue;
      const std::string words = DifferencesInWords(dataset.facts);
      if (!words.empty()) differences.push_back(fmt::format("{} ({})", dataset.name, words));
    }
    table->rows.push_back(MakePublishedRow(row, layout));
  }
  for (const DatasetResult& dataset : datasets) {
    const auto row =
        std::ranges::find(published_rows, FindPublishedName(dataset), &PublishedRow::dataset);
    if (row == published_rows.end()) add_measured(dataset);
  }
  if (!differences.empty()) {
    table->notes.push_back(
        fmt::format("Measured above published rows: {}.", fmt::join(differences, ", ")));
  }
}

// The row over the objects of all datasets with boxes of a detector that all variants have.
void AddDetectorRow(std::vector<DatasetResult> datasets, const Layout& layout, Table* table) {
  std::erase_if(datasets,
                [](const DatasetResult& dataset) { return !dataset.facts.HasDetectorBoxes(); });
  std::vector<std::string> measured, names;
  std::ranges::copy_if(layout.variants, std::back_inserter(measured), [&](const auto& name) {
    return std::ranges::any_of(
        datasets, [&](const auto& dataset) { return dataset.Evaluated(name) != nullptr; });
  });
  std::map<std::string, std::vector<double>> values;  // by variant
  for (const DatasetResult& dataset : datasets) {
    std::map<int, std::vector<double>> by_object;
    for (const std::string& name : measured) {
      const VariantResult* const variant = dataset.Evaluated(name);
      if (!variant) continue;
      for (const auto& [object, value] : ObjectValues(*variant, layout.metric)) {
        by_object[object].push_back(value);
      }
    }
    std::erase_if(by_object, [&](const auto& of) { return of.second.size() < measured.size(); });
    if (by_object.empty()) continue;
    names.push_back(dataset.name);
    for (const auto& [object, of_variants] : by_object) {
      for (size_t i = 0; i < measured.size(); ++i) values[measured[i]].push_back(of_variants[i]);
    }
  }
  if (names.size() < 2) return;
  Means means;
  for (const std::string& name : layout.variants) {
    const std::vector<double>& of_variant = values[name];
    means.emplace_back();
    if (const auto mean = MeanOf(of_variant)) {
      means.back() = {*mean, static_cast<int>(of_variant.size())};
    }
  }
  table->rows.push_back(MeasuredRow("detector's boxes", "common objects", means, layout));
  table->notes.push_back(fmt::format(
      "Detector's boxes: over the objects that all of {} have, all observations, of {}.",
      fmt::join(measured, ", "), fmt::join(names, ", ")));
}

// The row over the datasets that have a value in every column in which any dataset has one.
void AddAverage(const std::vector<DatasetResult>& datasets, const Layout& layout,
                const RowKind& kind, Table* table) {
  std::vector<Means> all;
  Means any(layout.variants.size());
  for (const DatasetResult& dataset : datasets) {
    all.push_back(CollectMeans(dataset, layout, kind));
    for (size_t i = 0; i < any.size(); ++i) {
      if (all.back()[i]) any[i] = all.back()[i];
    }
  }
  std::vector<std::string> names;
  std::vector<std::vector<ObjectMean>> columns(any.size());
  for (size_t k = 0; k < datasets.size(); ++k) {
    if (CountMeans(all[k]) == 0 || CountMeans(all[k]) < CountMeans(any)) continue;
    names.push_back(datasets[k].name);
    for (size_t i = 0; i < any.size(); ++i) {
      if (any[i]) columns[i].push_back(*all[k][i]);
    }
  }
  if (names.size() < 2) return;
  for (size_t i = 0; i < any.size(); ++i) {
    if (any[i]) any[i] = WeightedMean(columns[i]);
  }
  table->rows.push_back(MeasuredRow("average", kind.title, any, layout));
  table->notes.push_back(fmt::format(
      "Average ({}): weighted by objects, over the datasets in which no variant lacks a value: {}.",
      kind.title, fmt::join(names, ", ")));
}

}  // namespace

ObjectMean WeightedMean(const std::vector<ObjectMean>& means) {
  ObjectMean total;
  for (const ObjectMean& mean : means) {
    total.mean += mean.objects * mean.mean;
    total.objects += mean.objects;
    total.observations += mean.observations;
  }
  total.mean /= total.objects;
  return total;
}

std::vector<Table> PaperTables(const std::vector<DatasetResult>& datasets,
                               const Published& published) {
  std::vector<Table> tables;
  for (const Layout& layout : kLayouts) {
    const bool is_measured = std::ranges::any_of(datasets, [&](const DatasetResult& dataset) {
      return CountMeans(CollectMeans(dataset, layout, layout.row_kinds.front())) > 0;
    });
    if (!is_measured) continue;
    Table table = {layout.name,
                   fmt::format("{} (Table {})", layout.title, layout.number),
                   {"dataset", "values", "marks", "objects", "observations"},
                   {},
                   3,
                   {kBoldNote, MarksNote()}};
    table.header.insert(table.header.end(), layout.variants.begin(), layout.variants.end());
    const PublishedTable* const paper = published.Find(layout.number, layout.metric);
    AddDatasetRows(datasets, paper, layout, &table);
    for (const RowKind& kind : layout.row_kinds) AddAverage(datasets, layout, kind, &table);
    AddDetectorRow(datasets, layout, &table);
    if (paper) {
      table.rows.push_back(MakePublishedRow(paper->average, layout));
      table.notes.push_back(fmt::format("Published: {}{}{}.", paper->source,
                                        published.protocol.empty() ? "" : ": ",
                                        published.protocol));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace soslam
