// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "soslam/base/table.h"
#include "soslam/base/text.h"
#include "soslam/model/reasons.h"
#include "soslam/report/page.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"
#include "soslam/report/results_tree.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

constexpr const char* kDash = "–";

// "Rot, °"
std::string HeaderOnPage(const Metric& metric) {
  const std::string unit = metric.unit;
  return unit.empty() ? metric.title
                      : fmt::format("{}, {}", metric.title, unit == "deg" ? "°" : unit);
}

// "2 name, 1 other name"
template <typename Count>
std::string ListCounts(const std::map<std::string, Count>& counts) {
  std::vector<std::string> texts;
  for (const auto& [name, count] : counts) {
    texts.push_back(fmt::format("{} {}", count, WithBlanks(name)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

// Adds a column, unless there is no value. With `marks_best`, values that look equal to the best
// are bold.
void AddColumn(const std::string& title, const Metric& metric,
               const std::vector<std::optional<double>>& values, bool marks_best, Table* table) {
  std::optional<double> best;
  for (const std::optional<double>& value : values) {
    if (value && (!best || metric.IsBetter(*value, *best))) best = value;
  }
  if (!best) return;
  table->header.push_back(title);
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string text = metric.Text(values[i], kDash);
    table->rows[i].emplace_back(text, marks_best && text == metric.Text(best));
  }
}

// The numbers of all variants, or of those of a kind. Empty where there is nothing that any of them
// could be measured against, or no variant.
std::string MetricsTable(const DatasetPage& page, const std::optional<VariantKind>& kind = {}) {
  std::vector<const PageVariant*> variants;
  for (const PageVariant& variant : page.variants) {
    if (!kind || variant.kind == kind) variants.push_back(&variant);
  }
  Table table;
  table.name = "metrics";
  table.header = {"variant"};
  if (page.has_true_objects) table.header.insert(table.header.end(), {"objects", "observations"});
  for (const PageVariant* variant : variants) {
    const MetricsSummary& summary = variant->metrics.summary;
    table.rows.push_back({variant->name});
    if (!page.has_true_objects) continue;
    for (const int count : {summary.objects, summary.observations}) {
      table.rows.back().emplace_back(std::to_string(count));
    }
  }
  const auto add = [&](const std::string& title, const Metric& metric, const auto& value_of) {
    std::vector<std::optional<double>> values;
    for (const PageVariant* variant : variants) values.push_back(value_of(variant->metrics));
    AddColumn(title, metric, values, /*marks_best=*/true, &table);
  };
  for (const ObjectMetric& metric : kMeanMetrics) {
    add(HeaderOnPage(metric), metric,
        [&](const Metrics& metrics) { return metrics.summary.*metric.mean; });
  }
  for (const auto& metric : kFrontMetrics) {
    add(HeaderOnPage(metric), metric, [&](const Metrics& metrics) {
      const auto& fronts = metrics.summary.fronts;
      return fronts ? metric.of(*fronts).front() : std::nullopt;
    });
  }
  add(fmt::format("{}, first view", kIou.title), kIou, [](const Metrics& metrics) {
    return metrics.first_observation.value_or(MetricsSummary()).*kIou.mean;
  });
  // A metric of a part that not all variants have.
  const auto add_of = [&](const auto& metric, const auto& part) {
    add(HeaderOnPage(metric), metric, [&](const Metrics& metrics) {
      return metrics.*part ? metric.of(*(metrics.*part)).front() : std::nullopt;
    });
  };
  add_of(kTrajectoryError, &Metrics::trajectory);
  add_of(kHeldOutIou, &Metrics::held_out);
  return variants.empty() || table.header.size() == 1 ? "" : HtmlTable(table);
}

// Empty where nothing was measured.
std::string NumbersSection(const DatasetPage& page) {
  std::string tables;
  for (const auto& [kind, title] :
       {std::pair(VariantKind::kMap, "Maps: all frames, landmarks and poses together"),
        {VariantKind::kViews, "One landmark from all frames, poses as given"},
        {VariantKind::kFrames, "Single frames: mean over the observations of each object"}}) {
    const std::string table = MetricsTable(page, kind);
    if (!table.empty()) tables += fmt::format("<h3>{}</h3>\n{}", title, table);
  }
  if (tables.empty()) return "";
  std::string explained =
      page.has_true_objects
          ? "Means over objects, the best in bold. IoU: overlap of the cuboids around estimate and "
            "truth. Rot: the smallest turn that brings the axes of one onto any of the other. Yaw "
            "error: modulo half a turn. "
          : "The best is bold. ";
  if (page.has_true_poses) {
    explained += "ATE: root mean square error of the camera's positions.";
  }
  return Section("numbers", "Numbers", Faint(explained) + tables);
}

// Comparison of a dataset's maps with all true objects, independent of ids; empty without maps or
// without true objects.
std::string QualityHtml(const DatasetPage& page) {
  DatasetResult result{Utf8(page.name), {}};
  for (const PageVariant& variant : page.variants) {
    result.variants.push_back({variant.name, {}, variant.metrics});
  }
  std::string html;
  for (const Table& table : QualityTables(result)) {
    html += fmt::format("<h3>{}</h3>\n{}", HtmlText(table.title), HtmlTable(table));
    for (const std::string& note : table.notes) html += Faint(note);
  }
  return html;
}

std::string QualitySection(const DatasetPage& page) {
  const std::string tables = QualityHtml(page);
  if (tables.empty()) return "";
  std::string mistakes;
  for (const PageVariant& variant : page.variants) {
    const Table table = MistakesTable(variant.metrics);
    if (table.rows.empty()) continue;
    mistakes += fmt::format(
        "<details><summary>{}: what is missed or false, and why</summary>\n{}</details>\n",
        HtmlText(variant.name), HtmlTable(table));
  }
  return Section("quality", "Maps compared with all true objects",
                 Faint("Landmarks and true objects are matched by overlap, whatever their ids and "
                       "labels, in the world of the true poses: alignment none where the map is in "
                       "it, rigid where it has to be moved there, similarity where it is scaled as "
                       "well.") +
                     tables + mistakes);
}

// The observed objects in ascending order of IoU; those without IoU come last.
std::string ObjectsTable(const Sequence& sequence, const PageVariant& variant,
                         bool has_true_objects) {
  struct Row {
    size_t index;
    std::optional<ObjectMetrics> metrics;  // none without truth
  };
  std::vector<Row> rows;
  bool has_failures = false;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const auto& all = variant.metrics.objects;
    const auto found = std::ranges::find(all, sequence.objects[i].id, &ObjectMetrics::object_index);
    Row row = {i, found == all.end() ? std::nullopt : std::optional(*found)};
    const bool is_seen = row.metrics && row.metrics->observations > 0;
    if (!is_seen && !variant.objects[i].landmark_in_world) continue;
    has_failures |= !variant.objects[i].failure.empty();
    rows.push_back(std::move(row));
  }
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    const auto iou = row.metrics ? kIou.of(*row.metrics).front() : std::nullopt;
    return iou.value_or(std::numeric_limits<double>::infinity());
  });
  Table table;
  table.header = {"object", "observations"};
  std::vector<size_t> indices;
  for (const auto& [index, metrics] : rows) {
    const Object& object = sequence.objects[index];
    const int observations = metrics ? metrics->observations : variant.objects[index].observations;
    table.rows.push_back({ObjectName(object.label, object.id), std::to_string(observations)});
    indices.push_back(index);
  }
  const auto add = [&](const Metric& metric, const auto& value_of) {
    std::vector<std::optional<double>> values;
    for (const Row& row : rows) values.push_back(value_of(row));
    AddColumn(HeaderOnPage(metric), metric, values, /*marks_best=*/false, &table);
  };
  for (const ObjectMetric& metric : kObjectMetrics) {
    if (!has_true_objects) continue;
    add(metric, [&](const Row& row) {
      return row.metrics ? metric.of(*row.metrics).front() : std::nullopt;
    });
  }
  for (const auto& metric : kEstimateMetrics) {
    add(metric, [&](const Row& row) {
      const std::optional<double> value = metric.of(variant.objects[row.index]).front();
      return value ? OnPage(*value) : value;
    });
  }
  if (has_failures) {
    table.header.emplace_back("no landmark");
    for (size_t i = 0; i < rows.size(); ++i) {
      table.rows[i].emplace_back(ReasonOf(variant.objects[rows[i].index].failure).words);
    }
  }
  return HtmlTable(table, indices);
}

// A table for each variant; scripts show one of them at a time.
std::string ObjectsSection(const DatasetPage& page) {
  std::string tables;
  for (const size_t index : DetailedVariants(page)) {
    const PageVariant& variant = page.variants[index];
    tables += fmt::format(
        "<details{}><summary>{}</summary>\n{}</details>\n", tables.empty() ? " open" : "",
        HtmlText(variant.name),
        ObjectsTable(page.sequences[variant.sequence].sequence, variant, page.has_true_objects));
  }
  if (tables.empty()) return "";
  return Section(
      "objects", "Objects",
      (page.has_true_objects ? Faint("Worst first. Yaw error: modulo half a turn.") : "") + tables);
}

// Ablations: the effect of one more part, paired by object.
std::string AblationSection(const DatasetPage& page) {
  if (page.differences.empty()) return "";
  Table table;
  table.header = {"", "objects"};
  for (const ObjectMetric& metric : kMeanMetrics) table.header.push_back(HeaderOnPage(metric));
  const auto on_page = [](double value) { return OnPage(value).value_or(value); };
  for (const auto& [parts, objects, of_metrics] : page.differences) {
    table.rows.push_back(
        {fmt::format("{} – {}", parts.variant, parts.baseline), std::to_string(objects)});
    for (size_t i = 0; i < of_metrics.size(); ++i) {
      if (!of_metrics[i]) {
        table.rows.back().emplace_back(kDash);
        continue;
      }
      PairedDifference difference = *of_metrics[i];
      difference.mean = on_page(difference.mean);
      if (auto& interval = difference.confidence_95) {
        interval = {on_page(interval->low), on_page(interval->high)};
      }
      table.rows.back().push_back(WithInterval(difference, kMeanMetrics[i]));
    }
  }
  return Section("ablation", "What each part is worth",
                 "<p>Differences between two variants over the same objects: mean and, in "
                 "brackets, 95 % confidence interval (Student's t). Bold where the interval leaves "
                 "out zero.</p>\n" +
                     HtmlTable(table));
}

// Results of the stages of each variant.
std::string StagesSection(const DatasetPage& page) {
  Table table;
  table.name = "sentences";
  table.header = {"variant",   "landmarks", "objects without one", "iterations", "converged",
                  "residuals", "left out"};
  for (const size_t index : DetailedVariants(page)) {
    const PageVariant& variant = page.variants[index];
    int landmarks = 0;
    std::map<std::string, int> failures;
    for (const ObjectEstimate& estimate : variant.objects) {
      landmarks += estimate.landmark_in_world ? 1 : 0;
      if (!estimate.failure.empty()) ++failures[estimate.failure];
    }
    std::vector<Cell> row = {variant.name, std::to_string(landmarks),
                             ListCounts(ReasonsInWords(failures))};
    if (const auto& solver = variant.solver) {
      row.insert(row.end(), {std::to_string(solver->iterations), solver->converged ? "yes" : "no",
                             ListCounts(solver->residuals), ListCounts(solver->gated)});
    }
    row.resize(table.header.size(), "");
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return "";
  return Section("stages", "Stages",
                 Faint("Landmarks, and what the back end did where there is one: what went into "
                       "its problem and what was left out. Where texture and edges join in, the "
                       "cost rises: from there on it is that of a larger problem.") +
                     HtmlTable(table));
}

// Findings, unfinished variants with a row for each state, and files that cannot be shown.
std::string Remarks(const DatasetPage& page) {
  NamesByKey names_by_state;
  for (const auto& [name, state, is_shown] : page.unfinished) {
    names_by_state[state + (is_shown ? " (shown: the last complete run)" : "")].push_back(name);
  }
  Table table;
  table.name = "sentences";
  table.header = {"not complete", "state"};
  for (const auto& [state, names] : names_by_state) {
    table.rows.push_back({fmt::format("{}", fmt::join(names, ", ")), state});
  }
  std::string remarks = table.rows.empty() ? "" : HtmlTable(table);
  for (const std::string& problem : page.problems) remarks += Faint(problem);
  return remarks + FindingsHtml(page.findings);
}

// The variant of most interest.
const PageVariant& MainVariant(const DatasetPage& page) {
  const std::vector<size_t> detailed = DetailedVariants(page);
  return page.variants[detailed.empty() ? 0 : detailed.front()];
}

}  // namespace

std::vector<size_t> DetailedVariants(const DatasetPage& page) {
  std::vector<size_t> detailed;
  for (size_t i = 0; i < page.variants.size(); ++i) {
    if (!page.variants[i].numbers_only) detailed.push_back(i);
  }
  auto names = kKnownVariants;
  std::ranges::reverse(names);
  std::ranges::stable_sort(detailed, {}, [&](size_t index) {
    const PageVariant& variant = page.variants[index];
    // Names that end in A or R are of variants with evidence from pictures as well.
    const size_t end = variant.name.find_last_not_of("AR") + 1;
    const auto known = std::ranges::find(names, variant.name.substr(0, end));
    return std::tuple(variant.kind, known - names.begin(), end == variant.name.size());
  });
  return detailed;
}

std::string CountsOfDataset(const DatasetPage& page) {
  if (page.variants.empty()) return "";
  const PageVariant& main = MainVariant(page);
  const Sequence& sequence = page.sequences[main.sequence].sequence;
  std::set<size_t> others;  // numbers of detections in the sequences of other variants
  for (const ShownSequence& shown : page.sequences) {
    others.insert(shown.sequence.detections.size());
  }
  others.erase(sequence.detections.size());
  return fmt::format(
      "{}, {}, {} used{}", Counted(sequence.frames.size(), "frame"),
      Counted(sequence.objects.size(), "object"), Counted(sequence.detections.size(), "detection"),
      others.empty() ? ""
                     : fmt::format(" by {} (by others {})", main.name, fmt::join(others, ", ")));
}

std::string DatasetTables(const DatasetPage& page) {
  if (page.variants.empty()) return "";
  const ShownSequence& main = page.sequences[MainVariant(page).sequence];
  std::string counts = CountsOfDataset(page);
  const size_t shown = main.selection.shown.size();
  if (shown < main.sequence.frames.size()) counts += fmt::format("; {} frames are shown", shown);
  const auto& rejected = main.sequence.rejected_detections;
  if (!rejected.empty()) counts += "; not used: " + ListCounts(ReasonsInWords(rejected));
  std::string notes;
  for (const std::string& note : page.notes) notes += Faint(note);
  // A map may need all of the screen; the findings below it may be of other variants.
  std::string link;
  if (!page.findings.empty() && !page.map_section.empty()) {
    std::vector<std::string> places;
    for (const auto& [finding, where] : page.findings) {
      if (std::ranges::find(places, where) == places.end()) places.push_back(where);
    }
    link = fmt::format("<p><a href=\"#remarks\">{}</a> below, in {}</p>\n",
                       Counted(page.findings.size(), "finding"), HtmlText(NamesInWords(places)));
  }
  return fmt::format("<h1>{}</h1>\n", HtmlText(page.name)) + Faint(counts) + link +
         page.map_section + "<div id=\"remarks\">\n" + Remarks(page) + "</div>\n" +
         "<noscript><p class=\"faint\">The map in three dimensions, frames, charts and figures "
         "need JavaScript; all else is here.</p></noscript>\n" +
         NumbersSection(page) + QualitySection(page) + ObjectsSection(page) + page.boxes_section +
         AblationSection(page) + StagesSection(page) + notes;
}

std::string OverviewTables(const std::vector<DatasetPage>& pages) {
  std::string sections;
  for (const DatasetPage& page : pages) {
    const std::string url = EncodeUrl(page.name);
    std::string content = Faint("Nothing of it can be shown.");
    if (!page.variants.empty()) {
      content = fmt::format(
          "<p>{}. <a href=\"./{}/report.html\">Map, frames, objects and figures</a></p>\n",
          HtmlText(CountsOfDataset(page)), HtmlText(url));
    }
    content += Remarks(page) + MetricsTable(page);
    const std::string quality = QualityHtml(page);
    if (!quality.empty()) content += "<h3>Maps compared with all true objects</h3>\n" + quality;
    sections += Section(url, page.name, content);
  }
  return "<h1>Results</h1>\n" + sections;
}

}  // namespace soslam
