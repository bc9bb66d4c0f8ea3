// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "artefact/json_file.h"
#include "report/tables.h"

namespace soslam {

const PublishedTable* Published::Find(const std::string& number, const Quantity& quantity) const {
  const auto found = std::ranges::find_if(tables, [&](const PublishedTable& table) {
    return table.table == number && table.quantity == quantity.key;
  });
  return found == tables.end() ? nullptr : &*found;
}

Published ReadPublished(const std::filesystem::path& path) {
  return ReadDocument<Published>(ParseJsonFile(path), path.string());
}

namespace {

// A kind of rows of measured values.
struct RowKind {
  const char* summary;  // of metrics.json, "/summary/"
  const char* title;
};

struct Layout {
  const char* number;
  const char* name;
  const char* title;
  Quantity quantity;
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
const std::vector<RowKind> kSingleFrameRows = {{"/summary/", "all observations"},
                                               {"/first_observation/", "first observation"}};
const std::vector<RowKind> kMapRows = {{"/summary/", "measured"}};

const std::vector<Layout> kLayouts = {
    {"I", "table_1_initial_iou", "Initialisation, IoU", kIou, kInitialVariants, kSingleFrameRows},
    {"II", "table_2_initial_rotation", "Initialisation, Rot (degrees)", kRotation, kInitialVariants,
     kSingleFrameRows},
    {"III", "table_3_map_iou", "Map, IoU", kIou, kMapVariants, kMapRows},
    {"IV", "table_4_map_rotation", "Map, Rot (degrees)", kRotation, kMapVariants, kMapRows}};

// One mean per column.
using Means = std::vector<std::optional<ObjectMean>>;

bool HasAny(const Means& means) {
  return std::ranges::any_of(means, [](const auto& mean) { return mean.has_value(); });
}

// None without the quantity; the first observation exists for single-frame variants only. The
// number of objects is that of objects with an angle in any observation, as metrics.json does not
// have it for first observations.
std::optional<ObjectMean> MeanOverObjects(const VariantResult& variant, const Quantity& quantity,
                                          const std::string& summary) {
  const auto mean = MetricsNumber(variant, summary + quantity.key + "_mean");
  const auto count = MetricsNumber(variant, summary + "observations");
  const int objects = static_cast<int>(ObjectValues(variant, quantity).size());
  if (!mean || !count || objects == 0) return std::nullopt;
  return ObjectMean{*mean, objects, static_cast<int>(*count)};
}

Means MeansOf(const DatasetResult& dataset, const Layout& layout, const RowKind& kind) {
  Means means;
  for (const std::string& name : layout.variants) {
    const VariantResult* const variant = dataset.Evaluated(name);
    means.push_back(variant ? MeanOverObjects(*variant, layout.quantity, kind.summary)
                            : std::nullopt);
  }
  return means;
}

std::string ValueText(const ObjectMean& mean, const Quantity& quantity) {
  return fmt::format("{:.{}f}", mean.mean, quantity.decimals);
}

// The best value as displayed, so that values that look equal are equally good.
std::string BestText(const Means& means, const Quantity& quantity) {
  const ObjectMean* best = nullptr;
  for (const auto& mean : means) {
    if (!mean) continue;
    const bool is_better =
        !best || (quantity.higher_is_better ? mean->mean > best->mean : mean->mean < best->mean);
    if (is_better) best = &*mean;
  }
  return best ? ValueText(*best, quantity) : kNoValue;
}

// The most observations of a variant.
std::string ObservationsText(const Means& means, const std::vector<std::string>& variants) {
  std::set<int> counts;
  std::string variant_with_most;
  for (size_t i = 0; i < means.size(); ++i) {
    if (!means[i]) continue;
    if (counts.empty() || means[i]->observations > *counts.rbegin()) {
      variant_with_most = variants[i];
    }
    counts.insert(means[i]->observations);
  }
  if (counts.empty() || *counts.rbegin() == 0) return kNoValue;
  return std::to_string(*counts.rbegin()) +
         (counts.size() > 1 ? fmt::format(" ({})", variant_with_most) : "");
}

std::vector<Cell> MeasuredRow(const std::string& dataset, const std::string& kind,
                              const Means& means, const Layout& layout,
                              const DatasetFacts& facts = {}) {
  const Quantity& quantity = layout.quantity;
  int objects = 0;
  for (const auto& mean : means) objects = std::max(objects, mean ? mean->objects : 0);
  const std::string best = BestText(means, quantity);
  std::vector<Cell> row = {dataset, kind, MarksOf(facts, objects), std::to_string(objects),
                           ObservationsText(means, layout.variants)};
  for (const auto& mean : means) {
    if (!mean) {
      row.emplace_back(kNoValue);
    } else if (mean->objects < objects) {
      row.emplace_back(fmt::format("{} ({})", ValueText(*mean, quantity), mean->objects));
    } else {
      const std::string text = ValueText(*mean, quantity);
      row.emplace_back(text, text == best);
    }
  }
  return row;
}

std::vector<Cell> PublishedRowOf(const PublishedRow& published, const Layout& layout) {
  std::vector<Cell> row = {published.dataset, "published", kNoValue,
                           std::to_string(published.objects), kNoValue};
  for (const std::string& variant : layout.variants) {
    const auto value = published.values.find(variant);
    row.emplace_back(value == published.values.end()
                         ? kNoValue
                         : fmt::format("{:.{}f}", value->second, layout.quantity.decimals));
  }
  return row;
}

// Means of the datasets that have a value in every column in which any dataset has one.
struct Complete {
  std::vector<std::string> datasets;
  std::vector<Means> means;
};

Complete CompleteDatasets(const std::vector<DatasetResult>& datasets, const Layout& layout,
                          const RowKind& kind) {
  std::vector<Means> means;
  Means any(layout.variants.size());
  for (const DatasetResult& dataset : datasets) {
    means.push_back(MeansOf(dataset, layout, kind));
    for (size_t i = 0; i < any.size(); ++i) {
      if (means.back()[i]) any[i] = means.back()[i];
    }
  }
  const auto values = [](const Means& of) {
    return std::ranges::count_if(of, [](const auto& mean) { return mean.has_value(); });
  };
  Complete complete;
  for (size_t k = 0; k < datasets.size(); ++k) {
    if (!HasAny(means[k]) || values(means[k]) < values(any)) continue;
    complete.datasets.push_back(datasets[k].name);
    complete.means.push_back(means[k]);
  }
  return complete;
}

Means Averages(const Complete& complete) {
  Means averages;
  for (size_t i = 0; i < complete.means.front().size(); ++i) {
    std::vector<ObjectMean> column;
    for (const Means& means : complete.means) {
      if (means[i]) column.push_back(*means[i]);
    }
    averages.push_back(column.empty() ? std::nullopt : std::optional(WeightedMean(column)));
  }
  return averages;
}

// The published dataset that this one stands above.
std::string PublishedNameOf(const DatasetResult& dataset) {
  return dataset.facts.published.empty() ? dataset.name : dataset.facts.published;
}

// One row per dataset and kind, followed by the published values of the dataset: first the
// published datasets in their order, then the others.
void AddDatasetRows(const std::vector<DatasetResult>& datasets, const PublishedTable* published,
                    const Layout& layout, Table* table) {
  const auto add_measured = [&](const DatasetResult& dataset) {
    const size_t rows = table->rows.size();
    for (const RowKind& kind : layout.row_kinds) {
      const Means means = MeansOf(dataset, layout, kind);
      if (!HasAny(means)) continue;
      table->rows.push_back(MeasuredRow(dataset.name, kind.title, means, layout, dataset.facts));
    }
    return table->rows.size() > rows;
  };
  std::vector<std::string> differences;
  std::vector<PublishedRow> published_rows;
  if (published) published_rows = published->rows;
  for (const PublishedRow& row : published_rows) {
    for (const DatasetResult& dataset : datasets) {
      if (PublishedNameOf(dataset) != row.dataset || !add_measured(dataset)) continue;
      const std::string words = DifferencesInWords(dataset.facts);
      if (!words.empty()) differences.push_back(fmt::format("{} ({})", dataset.name, words));
    }
    table->rows.push_back(PublishedRowOf(row, layout));
  }
  for (const DatasetResult& dataset : datasets) {
    const auto row =
        std::ranges::find(published_rows, PublishedNameOf(dataset), &PublishedRow::dataset);
    if (row == published_rows.end()) add_measured(dataset);
  }
  if (!differences.empty()) {
    table->notes.push_back(
        fmt::format("Measured above published rows: {}.", fmt::join(differences, ", ")));
  }
}

// The objects of a dataset for which all of these variants have the quantity.
std::set<int> CommonObjects(const DatasetResult& dataset, const Quantity& quantity,
                            const std::vector<std::string>& variants) {
  std::map<int, size_t> variants_with;  // by object
  for (const std::string& name : variants) {
    const VariantResult* const variant = dataset.Evaluated(name);
    if (!variant) return {};
    for (const auto& [object, value] : ObjectValues(*variant, quantity)) ++variants_with[object];
  }
  std::set<int> common;
  for (const auto& [object, count] : variants_with) {
    if (count == variants.size()) common.insert(object);
  }
  return common;
}

std::optional<ObjectMean> MeanOver(const std::set<int>& objects, const VariantResult* variant,
                                   const Quantity& quantity) {
  if (!variant || objects.empty()) return std::nullopt;
  ObjectMean mean = {0.0, static_cast<int>(objects.size())};
  for (const auto& [object, value] : ObjectValues(*variant, quantity)) {
    if (objects.contains(object)) mean.mean += value / mean.objects;
  }
  return mean;
}

// The row over the objects of all datasets with boxes of a detector.
void AddDetectorRow(const std::vector<DatasetResult>& datasets, const Layout& layout,
                    Table* table) {
  std::vector<std::string> measured;
  for (const std::string& name : layout.variants) {
    const bool is_measured = std::ranges::any_of(datasets, [&](const DatasetResult& dataset) {
      return dataset.facts.HasDetectorBoxes() && dataset.Evaluated(name);
    });
    if (is_measured) measured.push_back(name);
  }
  Complete common;
  for (const DatasetResult& dataset : datasets) {
    if (!dataset.facts.HasDetectorBoxes()) continue;
    const std::set<int> objects = CommonObjects(dataset, layout.quantity, measured);
    if (objects.empty()) continue;
    common.datasets.push_back(dataset.name);
    common.means.emplace_back();
    for (const std::string& name : layout.variants) {
      common.means.back().push_back(MeanOver(objects, dataset.Evaluated(name), layout.quantity));
    }
  }
  if (common.datasets.size() < 2) return;
  table->rows.push_back(
      MeasuredRow("detector's boxes", "common objects", Averages(common), layout));
  table->notes.push_back(fmt::format(
      "Detector's boxes: over the objects that all of {} have, all observations, of {}.",
      fmt::join(measured, ", "), fmt::join(common.datasets, ", ")));
}

void AddAverages(const std::vector<DatasetResult>& datasets, const Layout& layout, Table* table) {
  for (const RowKind& kind : layout.row_kinds) {
    const Complete complete = CompleteDatasets(datasets, layout, kind);
    if (complete.datasets.size() < 2) continue;
    table->rows.push_back(MeasuredRow("average", kind.title, Averages(complete), layout));
    table->notes.push_back(fmt::format(
        "Average ({}): weighted by objects, over the datasets in which no variant lacks a value: "
        "{}.",
        kind.title, fmt::join(complete.datasets, ", ")));
  }
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
      return HasAny(MeansOf(dataset, layout, layout.row_kinds.front()));
    });
    if (!is_measured) continue;
    Table table = {layout.name,
                   fmt::format("{} (Table {})", layout.title, layout.number),
                   {"dataset", "values", "marks", "objects", "observations"},
                   {},
                   3,
                   {kBoldNote, MarksNote()}};
    table.header.insert(table.header.end(), layout.variants.begin(), layout.variants.end());
    const PublishedTable* const paper = published.Find(layout.number, layout.quantity);
    AddDatasetRows(datasets, paper, layout, &table);
    AddAverages(datasets, layout, &table);
    AddDetectorRow(datasets, layout, &table);
    if (paper) {
      table.rows.push_back(PublishedRowOf(paper->average, layout));
      table.notes.push_back(fmt::format("Published: {}{}{}.", paper->source,
                                        published.protocol.empty() ? "" : ": ",
                                        published.protocol));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace soslam
