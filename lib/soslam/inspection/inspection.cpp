// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/inspection.h"

#include <fmt/color.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "soslam/artefact/described_json.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/kinds.h"
#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/geometry/angles.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/metric_catalogue.h"

namespace soslam {
namespace {

using nlohmann::json;

// Provenance of an artefact: stage and software, inputs, and the settings that differ from these
// defaults.
std::vector<Fact> Provenance(const FileHeader& header, const json& defaults) {
  // Inputs are listed by name; if many have the same extension, such as images, by their number.
  constexpr size_t kMaxNames = 6;
  std::map<std::string, std::vector<std::string>> by_extension;
  for (const FileHeader::Input& input : header.inputs) {
    by_extension[std::filesystem::path(input.file).extension().string()].push_back(input.file);
  }
  std::vector<std::string> inputs, settings;
  for (auto& [extension, files] : by_extension) {
    const size_t count = files.size();
    if (count > kMaxNames) {
      inputs.push_back(fmt::format("{} {} files", count, extension));
    } else {
      inputs.insert(inputs.end(), files.begin(), files.end());
    }
  }
  for (const auto& [name, value] : header.settings.items()) {
    if (value == defaults.value(name, json())) continue;
    settings.push_back(fmt::format("{} {}", name, value.dump()));
  }
  return {{"made by",
           fmt::format("{}{}, schema version [{}]",
                       header.stage.empty() ? "" : fmt::format("soslam-{} of ", header.stage),
                       header.software, fmt::join(header.schema_version, ", "))},
          {"from", inputs.empty() ? "none" : fmt::format("{}", fmt::join(inputs, ", "))},
          {"settings",
           settings.empty() ? "all as by default" : fmt::format("{}", fmt::join(settings, ", "))}};
}

// Kinds of HDF5 files, and what they hold.
const std::map<std::string, std::string> kHdf5Kinds = {
    {"appearance", "which side of its object each box shows"},
    {"edges", "edges, distances and corners of images"},
    {"head", "which way things face, from the inner layers of a detector network"},
    {"matches", "points that several images show"},
    {"points", "sparse points of structure from motion"},
    {"symmetry", "what symmetry and edges say about the yaw of observations"}};

std::ptrdiff_t FindColumn(const ValueTable& table, const char* name) {
  return std::ranges::find(table.columns, name, &ValueColumn::name) - table.columns.begin();
}

// The column with the ids of objects; the number of columns where there is none.
std::ptrdiff_t ColumnOfObject(const ValueTable& table) {
  return std::min(FindColumn(table, "object"), FindColumn(table, "object_id"));
}

// Adds the labels of objects where the artefact has none.
void AddLabels(const Sequence& sequence, ValueTable* table) {
  const auto count = std::ssize(table->columns);
  const auto object = ColumnOfObject(*table);
  if (object == count || FindColumn(*table, "label") != count) return;
  table->columns.insert(table->columns.begin() + object + 1, {"label", "of the object"});
  for (std::vector<Value>& row : table->rows) {
    const auto found = std::ranges::find_if(
        sequence.objects, [&](const Object& one) { return row[object] == one.id; });
    row.insert(row.begin() + object + 1,
               found == sequence.objects.end() ? Value() : Value(found->label));
  }
}

const std::vector<ValueColumn> kDerivedColumns = {
    {"yaw_deg", "of the x axis about the object's own z axis"},
    {"sigma_centre_m", "standard deviation of the centre, over all directions"},
    {"sigma_yaw_deg", "standard deviation of the yaw"},
    {"sigma_size_percent", "root mean square of the standard deviations of the half axes"}};

std::vector<Value> DeriveCells(const ObjectEstimate& estimate) {
  std::vector<Value> cells(kDerivedColumns.size());
  if (!estimate.landmark_in_world) return cells;
  const Eigen::Quaterniond& rotation = estimate.landmark_in_world->frame_from_object.rotation;
  cells[0] = kDegPerRad * Yaw(rotation * Eigen::Vector3d::UnitZ(), rotation);
  if (!estimate.covariance) return cells;
  cells[1] = std::sqrt(estimate.covariance->block<3, 3>(3, 3).trace());
  cells[2] = *YawSigmaDeg(estimate);
  cells[3] = 100.0 * std::sqrt(estimate.covariance->bottomRightCorner<3, 3>().trace() / 3.0);
  return cells;
}

// Adds to the tables of landmarks.json or map.json what no field states: the yaws of landmarks, and
// the standard deviations of their places, yaws and sizes.
void AddDerivedColumns(const std::string& kind, const json& document, Inspection* inspection) {
  LandmarkEstimates estimates;
  if (kind == "landmarks") {
    estimates = DescribedFromJson<Artefact<LandmarkEstimates>>(document).body;
  } else if (kind == "map") {
    estimates.objects = DescribedFromJson<Artefact<MapEstimate>>(document).body.objects;
  }
  std::vector<std::vector<Value>> observations, objects;
  for (const ObservationEstimate& one : estimates.observations) {
    ObjectEstimate best;
    if (!one.hypotheses.empty()) best.landmark_in_world = one.hypotheses.front().landmark_in_camera;
    observations.push_back(DeriveCells(best));
  }
  for (const ObjectEstimate& one : estimates.objects) objects.push_back(DeriveCells(one));
  for (const auto& [name, cells] :
       {std::pair("observations", observations), {"objects", objects}}) {
    const auto table = std::ranges::find(inspection->tables, name, &ValueTable::name);
    if (cells.empty()) continue;
    table->columns.insert(table->columns.end(), kDerivedColumns.begin(), kDerivedColumns.end());
    for (size_t i = 0; i < cells.size(); ++i) {
      table->rows[i].insert(table->rows[i].end(), cells[i].begin(), cells[i].end());
    }
  }
}

std::string Styled(fmt::emphasis emphasis, const std::string& text, bool is_coloured) {
  return is_coloured ? fmt::format(fmt::text_style(emphasis), "{}", text) : text;
}

// Fields of a record stand below its name, and what they are beside their values.
std::string FormatFacts(const std::vector<Fact>& facts, bool is_coloured) {
  constexpr size_t kLineWidth = 110, kValueWidth = 10;
  const auto field_of = [](const Fact& fact) { return fact.name.substr(fact.name.rfind('/') + 1); };
  size_t width = 0;
  for (const Fact& fact : facts) width = std::max(width, 2 + CountCharacters(field_of(fact)));
  const size_t indent = 2 + width + 2, doc_indent = indent + kValueWidth + 2;
  std::string text, record;
  for (const Fact& fact : facts) {
    std::string name = field_of(fact);
    const std::string record_of_fact = fact.name.substr(0, fact.name.size() - name.size());
    if (record_of_fact != record && !record_of_fact.empty()) {
      text += "  " + record_of_fact.substr(0, record_of_fact.size() - 1) + "\n";
    }
    record = record_of_fact;
    if (!record.empty()) name.insert(0, "  ");
    name.resize(name.size() + width - CountCharacters(name), ' ');
    std::string value = Wrapped(fact.text, kLineWidth - indent, indent);
    if (!fact.doc.empty()) {
      const size_t used = CountCharacters(fact.text);
      value += used <= kValueWidth ? std::string(kValueWidth + 2 - used, ' ')
                                   : "\n" + std::string(doc_indent, ' ');
      value += Wrapped(fact.doc, kLineWidth - doc_indent, doc_indent);
    }
    text += "  " + Styled(fmt::emphasis::faint, name, is_coloured) + "  " + value + "\n";
  }
  return text;
}

std::string FormatTitle(const ValueTable& table, bool is_coloured) {
  return "\n" + Styled(fmt::emphasis::bold, table.name, is_coloured) +
         fmt::format(", {}{}{}\n", Counted(table.rows.size(), "row"), table.doc.empty() ? "" : ": ",
                     table.doc);
}

constexpr size_t kTableWidth = 140;

}  // namespace

Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence,
                   const json& default_settings) {
  const json header = ReadArtefactHeader(file);
  const std::string kind = header.at("kind");
  const ArtefactKind* const of_json = FindArtefactKind(kind);
  const auto of_hdf5 = kHdf5Kinds.find(kind);
  if (of_json == nullptr && of_hdf5 == kHdf5Kinds.end()) {
    std::vector<std::string> known;
    for (const auto& [name, title] : kHdf5Kinds) known.push_back(name);
    for (const ArtefactKind& one : ArtefactKinds()) known.push_back(one.name);
    std::ranges::sort(known);
    throw InputError(fmt::format("{}: artefact kind is \"{}\"; expected one of {}", file.string(),
                                 kind, fmt::join(known, ", ")));
  }
  CheckArtefactHeader(header, kind, file.string());
  Inspection inspection;
  std::vector<Finding> findings;
  if (of_json != nullptr) {
    const json document = ReadArtefact(file, kind);
    inspection = InspectContents(of_json->schema(), document);
    AddDerivedColumns(kind, document, &inspection);
    findings = ReadFindings(document);
  } else {
    inspection = InspectContents(OpenArtefact(file, kind));
  }
  if (sequence) {
    for (ValueTable& table : inspection.tables) AddLabels(*sequence, &table);
  }
  inspection.title = fmt::format("{}: {} ({})", file.string(), kind,
                                 of_json != nullptr ? of_json->title : of_hdf5->second);
  const std::vector<Fact> provenance =
      Provenance(ReadDocument<FileHeader>(header, file.string()), default_settings);
  inspection.facts.insert(inspection.facts.begin(), provenance.begin(), provenance.end());
  for (const Finding& finding : findings) {
    inspection.facts.push_back({NameOf(finding.severity), OneLine(InWords(finding))});
  }
  return inspection;
}

std::string FormatInspection(const Inspection& inspection, bool is_coloured) {
  constexpr size_t kRows = 12;
  constexpr size_t kMostValues = 8;
  std::string text = Styled(fmt::emphasis::bold, inspection.title, is_coloured) + "\n" +
                     FormatFacts(inspection.facts, is_coloured);
  for (const ValueTable& table : inspection.tables) {
    text += FormatTitle(table, is_coloured) + FormatTable(table, is_coloured, {kRows, kTableWidth});
    if (table.rows.size() <= kRows) continue;
    text += fmt::format("... and {} more (--table {})\n", table.rows.size() - kRows, table.name);
    // Columns of few different texts are told by their counts: "fate: 5 object, 2 merged".
    for (size_t k = 0; k < table.columns.size(); ++k) {
      std::map<std::string, int> counts;
      for (const std::vector<Value>& row : table.rows) {
        if (row[k].is_string() || row[k].is_boolean()) ++counts[InWords(row[k])];
      }
      counts.erase("");
      if (counts.empty() || counts.size() > kMostValues) continue;
      text += fmt::format("  {}: {}\n", table.columns[k].name, CountsInWords(counts));
    }
  }
  return text;
}

void KeepObject(int id, Inspection* inspection) {
  for (ValueTable& table : inspection->tables) {
    const std::ptrdiff_t object = ColumnOfObject(table);
    std::erase_if(table.rows, [&](const std::vector<Value>& row) {
      return object == std::ssize(row) || row[object] != id;
    });
  }
  std::erase_if(inspection->tables, [](const ValueTable& table) { return table.rows.empty(); });
  if (inspection->tables.empty()) {
    throw SettingsError(fmt::format(
        "--object {}: {} has no row of it; expected the id of an object", id, inspection->title));
  }
}

const ValueTable& FindTable(const Inspection& inspection, const std::optional<std::string>& name) {
  std::vector<std::string> known;
  for (const ValueTable& table : inspection.tables) {
    if (!name || table.name == *name) return table;
    known.push_back(table.name);
  }
  if (!name) {
    throw SettingsError(
        fmt::format("--csv: {} has no tables; its values are shown without", inspection.title));
  }
  throw SettingsError(
      fmt::format("--table {}: {} has no such table; expected one of {}", *name, inspection.title,
                  known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
}

std::string FormatWholeTable(const ValueTable& table, bool is_coloured) {
  std::vector<Fact> columns;
  for (const ValueColumn& column : table.columns) columns.push_back({column.name, "", column.doc});
  return FormatTitle(table, is_coloured) + FormatTable(table, is_coloured, {.width = kTableWidth}) +
         "\n" + FormatFacts(columns, is_coloured);
}

}  // namespace soslam
