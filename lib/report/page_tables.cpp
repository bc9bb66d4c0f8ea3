// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/table.h"
#include "base/text.h"
#include "inspection/inspection.h"
#include "report/page.h"
#include "report/page_html.h"
#include "report/page_parts.h"
#include "report/results_tree.h"
#include "report/tables.h"

namespace soslam {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

std::string NumberOrDash(const json& value, int decimals) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), decimals) : "–";
}

// {"name": count, ...} as "2 name, 1 other name".
std::string ListOf(const json& counts) {
  std::vector<std::string> texts;
  for (const auto& [name, count] : counts.items()) {
    texts.push_back(fmt::format("{} {}", count.get<size_t>(), WithBlanks(name)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string Faint(const std::string& text) {
  return fmt::format("<p class=\"faint\">{}</p>\n", HtmlText(text));
}

std::string Section(const std::string& id, const std::string& title, const std::string& content) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", HtmlText(id),
                     HtmlText(title), content);
}

// A column of the numbers of all variants, with its JSON pointer into metrics.json.
struct PageColumn {
  const char* title;
  const char* pointer;
  int decimals;
  bool higher_is_better;
};
constexpr std::array<PageColumn, 6> kPageColumns = {{
    {"IoU", "/summary/iou_mean", 3, true},
    {"Rot, °", "/summary/rotation_deg_mean", 2, false},
    {"yaw error, °", "/summary/yaw_error_deg_mean", 2, false},
    {"IoU, first view", "/first_observation/iou_mean", 3, true},
    {"ATE, m", "/trajectory/ate_rmse_m", 4, false},
    {"held-out IoU", "/held_out/iou_mean", 3, true},
}};

// Adds a column, unless no variant has a value. Values that look equal to the best are bold, too.
void AddColumn(const PageColumn& column, const std::vector<json>& variants, Table* table) {
  std::vector<json> values;
  std::optional<double> best;
  for (const json& variant : variants) {
    values.push_back(variant.at("metrics").value(Pointer(column.pointer), json()));
    if (!values.back().is_number()) continue;
    const auto value = values.back().get<double>();
    best = !best                     ? value
           : column.higher_is_better ? std::max(*best, value)
                                     : std::min(*best, value);
  }
  if (!best) return;
  table->header.emplace_back(column.title);
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string text = NumberOrDash(values[i], column.decimals);
    table->rows[i].emplace_back(text, text == NumberOrDash(*best, column.decimals));
  }
}

// Empty where there is nothing that any of the variants could be measured against, or no variant.
std::string MetricsTable(const std::vector<json>& variants, bool has_true_objects) {
  if (variants.empty()) return "";
  Table table;
  table.name = "metrics";
  table.header = {"variant"};
  if (has_true_objects) table.header.insert(table.header.end(), {"objects", "observations"});
  for (const json& variant : variants) {
    const json& summary = variant.at("metrics").at("summary");
    table.rows.push_back({variant.at("name").get<std::string>()});
    if (!has_true_objects) continue;
    for (const char* key : {"objects", "observations"}) {
      table.rows.back().emplace_back(summary.at(key).dump());
    }
  }
  for (const PageColumn& column : kPageColumns) AddColumn(column, variants, &table);
  return table.header.size() == 1 ? "" : HtmlTable(table);
}

// What the columns of MetricsTable mean.
std::string NumbersExplained(const json& page) {
  std::string text;
  if (page.at("has_true_objects")) {
    text +=
        "Means over objects, the best in bold. IoU: overlap of the cuboids around estimate and "
        "truth. Rot: the smallest turn that brings the axes of one onto any of the other. Yaw "
        "error: modulo half a turn. ";
  } else {
    text += "The best is bold. ";
  }
  if (page.at("has_true_poses")) text += "ATE: root mean square error of the camera's positions.";
  return Faint(text);
}

// Empty where nothing was measured.
std::string NumbersSection(const json& page) {
  constexpr std::array<std::array<const char*, 2>, 3> kKinds = {
      {{"map", "Maps: all frames, landmarks and poses together"},
       {"views", "One landmark from all frames, poses as given"},
       {"frames", "Single frames: mean over the observations of each object"}}};
  std::string tables;
  for (const auto& [kind, title] : kKinds) {
    std::vector<json> variants;
    for (const json& variant : page.at("variants")) {
      if (variant.at("kind") == kind) variants.push_back(variant);
    }
    const std::string table = MetricsTable(variants, page.at("has_true_objects"));
    if (!table.empty()) tables += fmt::format("<h3>{}</h3>\n{}", title, table);
  }
  if (tables.empty()) return "";
  return Section("numbers", "Numbers", NumbersExplained(page) + tables);
}

// Comparison of a dataset's maps with all true objects, independent of ids; empty without maps or
// without true objects.
std::string QualityHtml(const std::string& dataset, const std::vector<json>& variants) {
  DatasetResult result{dataset, {}};
  for (const json& variant : variants) {
    result.variants.push_back({variant.at("name"), {}, variant.at("metrics")});
  }
  std::string html;
  for (const Table& table : QualityTables(result)) {
    html += fmt::format("<h3>{}</h3>\n{}", HtmlText(table.title), HtmlTable(table));
    for (const std::string& note : table.notes) html += Faint(note);
  }
  return html;
}

// The missed objects and false landmarks of each map, with their reasons.
std::string Mistakes(const std::vector<json>& variants) {
  std::string html;
  for (const json& variant : variants) {
    const Table table = MistakesTable(variant.at("metrics"));
    if (table.rows.empty()) continue;
    html += fmt::format(
        "<details><summary>{}: what is missed or false, and why</summary>\n{}</details>\n",
        HtmlText(variant.at("name")), HtmlTable(table));
  }
  return html;
}

std::string QualitySection(const json& page) {
  const std::string table = QualityHtml(page.at("dataset"), page.at("variants"));
  if (table.empty()) return "";
  return Section("quality", "Maps compared with all true objects",
                 Faint("Landmarks and true objects are matched by overlap, whatever their ids and "
                       "labels, in the world of the true poses: alignment none where the map is in "
                       "it, rigid where it has to be moved there, similarity where it is scaled as "
                       "well.") +
                     table + Mistakes(page.at("variants")));
}

// An object of a variant; its metrics are empty if there are none.
struct ObjectRow {
  size_t index;
  json metrics;
  json estimate;

  double Iou() const {
    const json iou = metrics.value("iou", json());
    return iou.is_number() ? iou.get<double>() : std::numeric_limits<double>::infinity();
  }
};

// Observed objects in ascending order of IoU; those without IoU come last.
std::vector<ObjectRow> WorstFirst(const json& objects, const json& variant) {
  std::map<int, json> metrics_of;
  for (const json& metrics : variant.at("metrics").at("objects")) {
    metrics_of[metrics.at("object").get<int>()] = metrics;
  }
  std::vector<ObjectRow> rows;
  for (size_t i = 0; i < objects.size(); ++i) {
    const json& estimate = variant.at("objects").at(i);
    const auto found = metrics_of.find(objects[i].at("id").get<int>());
    const json metrics = found == metrics_of.end() ? json::object() : found->second;
    const bool is_seen = metrics.value("observations", 0) > 0;
    if (is_seen || !estimate.at("landmark").is_null()) rows.push_back({i, metrics, estimate});
  }
  std::ranges::stable_sort(rows, {}, &ObjectRow::Iou);
  return rows;
}

std::string ObjectsTable(const json& objects, const json& variant, bool has_true_objects) {
  const std::vector<ObjectRow> rows = WorstFirst(objects, variant);
  const auto failure = [](const ObjectRow& row) { return WithBlanks(row.estimate.at("failure")); };
  Table table;
  table.header = {"object", "observations"};
  if (has_true_objects) {
    table.header.insert(table.header.end(), {"IoU", "centre error, m", "Rot, °", "yaw error, °"});
  }
  table.header.emplace_back("yaw sigma, °");
  const bool has_failures =
      std::ranges::any_of(rows, [&](const ObjectRow& row) { return !failure(row).empty(); });
  if (has_failures) table.header.emplace_back("no landmark");
  std::vector<size_t> indices;
  for (const ObjectRow& row : rows) {
    const json& object = objects[row.index];
    const auto number = [&](const char* key, int decimals) {
      return NumberOrDash(row.metrics.value(key, json()), decimals);
    };
    table.rows.push_back(
        {ObjectName(object, "id"),
         row.metrics.value("observations", row.estimate.at("observations")).dump()});
    if (has_true_objects) {
      table.rows.back().insert(table.rows.back().end(),
                               {number("iou", 3), number("centre_m", 3), number("rotation_deg", 2),
                                number("yaw_error_deg", 2)});
    }
    table.rows.back().emplace_back(NumberOrDash(row.estimate.value("sigma_yaw_deg", json()), 2));
    if (has_failures) table.rows.back().emplace_back(failure(row));
    indices.push_back(row.index);
  }
  return HtmlTable(table, indices);
}

// A table for each variant; scripts show one of them at a time.
std::string ObjectsSection(const json& page) {
  const bool has_true_objects = page.at("has_true_objects");
  std::string tables;
  for (const size_t index : DetailedVariants(page)) {
    const json& variant = page.at("variants")[index];
    const json& sequence = page.at("sequences").at(variant.at("sequence").get<size_t>());
    tables += fmt::format("<details{}><summary>{}</summary>\n{}</details>\n",
                          tables.empty() ? " open" : "", HtmlText(variant.at("name")),
                          ObjectsTable(sequence.at("objects"), variant, has_true_objects));
  }
  if (tables.empty()) return "";
  return Section(
      "objects", "Objects",
      (has_true_objects ? Faint("Worst first. Yaw error: modulo half a turn.") : "") + tables);
}

std::string Signed(const json& value, int decimals) {
  return value.is_number() ? fmt::format("{:+.{}f}", value.get<double>(), decimals) : "–";
}

// A mean difference with its interval, bold if that excludes zero.
Cell IntervalCell(const json& difference, int decimals) {
  const std::string mean = Signed(difference.at("mean"), decimals);
  if (difference.at("low").is_null()) return mean;
  const auto low = difference.at("low").get<double>(), high = difference.at("high").get<double>();
  return {fmt::format("{} ({} to {})", mean, Signed(low, decimals), Signed(high, decimals)),
          low * high > 0.0};
}

// Ablations: the effect of one more part, paired by object.
std::string AblationSection(const json& page) {
  Table table;
  table.header = {"", "objects", "IoU", "Rot, °", "yaw error, °"};
  for (const json& pair : page.at("differences")) {
    table.rows.push_back({FillIn("{with} – {without}", pair), pair.at("objects").dump(),
                          IntervalCell(pair.at("iou"), 3), IntervalCell(pair.at("rotation_deg"), 2),
                          IntervalCell(pair.at("yaw_error_deg"), 2)});
  }
  if (table.rows.empty()) return "";
  return Section("ablation", "What each part is worth",
                 "<p>Differences between two variants over the same objects: mean and, in "
                 "brackets, 95 % confidence interval (Student's t). Bold where the interval leaves "
                 "out zero.</p>\n" +
                     HtmlTable(table));
}

std::vector<Cell> StagesRow(const json& variant) {
  const json& objects = variant.at("objects");
  const auto landmarks = std::ranges::count_if(
      objects, [](const json& object) { return !object.at("landmark").is_null(); });
  std::vector<Cell> row = {variant.at("name").get<std::string>(), std::to_string(landmarks),
                           ListOf(json(CountsBy("failure", objects)))};
  const json& solver = variant.at("solver");
  if (solver.is_null()) {
    row.resize(7, "");
    return row;
  }
  row.insert(row.end(), {solver.at("iterations").dump(), solver.at("converged") ? "yes" : "no",
                         ListOf(solver.at("residuals")), ListOf(solver.at("gated"))});
  return row;
}

// Results of the stages of each variant.
std::string StagesSection(const json& page) {
  Table table;
  table.name = "sentences";
  table.header = {"variant",   "landmarks", "objects without one", "iterations", "converged",
                  "residuals", "left out"};
  for (const size_t index : DetailedVariants(page)) {
    table.rows.push_back(StagesRow(page.at("variants")[index]));
  }
  if (table.rows.empty()) return "";
  return Section("stages", "Stages",
                 Faint("Landmarks, and what the back end did where there is one: what went into "
                       "its problem and what was left out. Where texture and edges join in, the "
                       "cost rises: from there on it is that of a larger problem.") +
                     HtmlTable(table));
}

// Planned variants that are missing or older than the plan: a row for each state.
std::string UnfinishedTable(const json& unfinished) {
  NamesByKey names_by_state;
  for (const json& variant : unfinished) {
    const std::string state = variant.at("state").get<std::string>() +
                              (variant.at("is_shown") ? " (shown: the last complete run)" : "");
    names_by_state[state].push_back(variant.at("name").get<std::string>());
  }
  if (names_by_state.empty()) return "";
  Table table;
  table.name = "sentences";
  table.header = {"not complete", "state"};
  for (const auto& [state, names] : names_by_state) {
    table.rows.push_back({fmt::format("{}", fmt::join(names, ", ")), state});
  }
  return HtmlTable(table);
}

// Findings, unfinished variants and files that cannot be shown.
std::string Remarks(const json& page) {
  std::string remarks = UnfinishedTable(page.at("unfinished"));
  for (const json& text : page.at("problems")) remarks += Faint(text);
  return remarks + FindingsHtml(page.at("findings"));
}

// What is not on the page.
std::string Notes(const json& page) {
  std::string notes;
  for (const json& text : page.at("notes")) notes += Faint(text);
  return notes;
}

// Where findings are below a map that may need all of the screen, and may be of other variants.
std::string LinkToFindings(const json& page) {
  const size_t count = page.at("findings").size();
  if (count == 0 || page.at("map_section").get_ref<const std::string&>().empty()) return "";
  std::vector<std::string> places;
  for (const json& finding : page.at("findings")) {
    const auto place = finding.at("where").get<std::string>();
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  return fmt::format("<p><a href=\"#remarks\">{}</a> below, in {}</p>\n", Counted(count, "finding"),
                     HtmlText(NamesInWords(places)));
}

// The variant of most interest.
const json& MainVariant(const json& page) {
  const std::vector<size_t> detailed = DetailedVariants(page);
  return page.at("variants")[detailed.empty() ? 0 : detailed.front()];
}

}  // namespace

std::string CountsOfDataset(const json& page) {
  if (page.at("variants").empty()) return "";
  const json& main = MainVariant(page);
  const json& counts = page.at("sequences").at(main.at("sequence").get<size_t>()).at("counts");
  std::set<size_t> others;  // numbers of detections in the sequences of other variants
  for (const json& sequence : page.at("sequences")) {
    others.insert(sequence.at("counts").at("detections").get<size_t>());
  }
  others.erase(counts.at("detections").get<size_t>());
  return fmt::format("{}, {}, {} used{}", Counted(counts.at("frames").get<size_t>(), "frame"),
                     Counted(counts.at("objects").get<size_t>(), "object"),
                     Counted(counts.at("detections").get<size_t>(), "detection"),
                     others.empty()
                         ? ""
                         : fmt::format(" by {} (by others {})", main.at("name").get<std::string>(),
                                       fmt::join(others, ", ")));
}

std::string DatasetTables(const json& page) {
  if (page.at("variants").empty()) return "";
  const json& sequence = page.at("sequences").at(MainVariant(page).at("sequence").get<size_t>());
  std::string counts = CountsOfDataset(page);
  const json& frames = sequence.at("frames");
  const auto shown = std::ranges::count_if(
      frames, [](const json& frame) { return frame.at("shown").get<bool>(); });
  if (shown < sequence.at("counts").at("frames"))
    counts += fmt::format("; {} frames are shown", shown);
  if (!sequence.at("rejected").empty()) counts += "; not used: " + ListOf(sequence.at("rejected"));
  return fmt::format("<h1>{}</h1>\n", HtmlText(page.at("dataset"))) + Faint(counts) +
         LinkToFindings(page) + page.at("map_section").get<std::string>() +
         "<div id=\"remarks\">\n" + Remarks(page) + "</div>\n" +
         "<noscript><p class=\"faint\">The map in three dimensions, frames, charts and figures "
         "need JavaScript; all else is here.</p></noscript>\n" +
         NumbersSection(page) + QualitySection(page) + ObjectsSection(page) +
         AblationSection(page) + StagesSection(page) + Notes(page);
}

std::string OverviewTables(const json& overview) {
  std::string sections;
  for (const json& dataset : overview.at("datasets")) {
    const auto url = dataset.at("url").get<std::string>();
    std::string content = Faint("Nothing of it can be shown.");
    if (dataset.at("counts") != "") {
      content = fmt::format(
          "<p>{}. <a href=\"./{}/report.html\">Map, frames, objects and figures</a></p>\n",
          HtmlText(dataset.at("counts")), HtmlText(url));
    }
    content += Remarks(dataset);
    if (!dataset.at("variants").empty()) {
      const std::string quality = QualityHtml(dataset.at("dataset"), dataset.at("variants"));
      content += MetricsTable(dataset.at("variants"), dataset.at("has_true_objects"));
      if (!quality.empty()) content += "<h3>Maps compared with all true objects</h3>\n" + quality;
    }
    sections += Section(url, dataset.at("dataset"), content);
  }
  return "<h1>Results</h1>\n" + sections;
}

}  // namespace soslam
