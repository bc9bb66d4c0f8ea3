// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/inspection.h"

#include <fmt/color.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "artefact/hdf5_artefact.h"
#include "artefact/json_file.h"
#include "artefact/kinds.h"
#include "association/options.h"
#include "base/error.h"
#include "base/options.h"
#include "base/table.h"
#include "base/text.h"
#include "dataset/import_options.h"
#include "dataset/reconstruct_options.h"
#include "evaluation/alignment.h"
#include "ground/options.h"
#include "image/edge_maps.h"
#include "image/feature_tracks.h"
#include "image/frame_choice.h"
#include "initialisation/options.h"
#include "mapping/options.h"
#include "orientation/options.h"
#include "planes/options.h"
#include "priors/learn_priors.h"

namespace soslam {
namespace {

using nlohmann::json;

// A stage, the kinds of its artefacts, and its options.
struct Maker {
  const char* stage;
  std::vector<std::string> kinds;
  json defaults;
};

const std::vector<Maker>& Makers() {
  static const std::vector<Maker> makers = {
      {"frames", {"frames"}, OptionsToJson(FrameOptions())},
      {"reconstruct", {"points", "reconstruction"}, OptionsToJson(ReconstructOptions())},
      {"track", {"points"}, OptionsToJson(TrackOptions())},
      {"import", {"sequence"}, OptionsToJson(ImportOptions())},
      {"associate", {"associations", "sequence"}, OptionsToJson(AssociateOptions())},
      {"planes", {"planes", "sequence"}, OptionsToJson(PlanesOptions())},
      {"ground", {"sequence", "world"}, OptionsToJson(GroundOptions())},
      {"edges", {"edges"}, OptionsToJson(EdgesOptions())},
      {"initialise", {"landmarks"}, OptionsToJson(InitialiseOptions())},
      {"refine", {"landmarks", "symmetry"}, OptionsToJson(OrientationOptions())},
      {"optimise", {"map"}, OptionsToJson(OptimiseOptions())},
      {"evaluate", {"metrics"}, OptionsToJson(EvaluateOptions())},
      {"learn-priors", {"semantic_table"}, OptionsToJson(LearnPriorsOptions())}};
  return makers;
}

// Headers do not name the stage. It is the one whose options share most names with the settings.
const Maker* MakerOf(const std::string& kind, const json& settings) {
  const Maker* best = nullptr;
  size_t most = 0;
  for (const Maker& maker : Makers()) {
    if (std::ranges::find(maker.kinds, kind) == maker.kinds.end()) continue;
    size_t shared = 0;
    for (const auto& item : settings.items()) shared += maker.defaults.count(item.key());
    if (best == nullptr || shared > most) {
      best = &maker;
      most = shared;
    }
  }
  return best;
}

std::string SettingsInWords(const json& settings, const json& defaults) {
  std::vector<std::string> words;
  for (const auto& [name, value] : settings.items()) {
    const json standard = defaults.value(name, json());
    if (value == standard) continue;
    words.push_back(fmt::format("{} {}", name, value.dump()));
  }
  return words.empty() ? "all as by default" : fmt::format("{}", fmt::join(words, ", "));
}

// Lists inputs by name; if many have the same extension, such as images, by their number.
std::string InputsInWords(const json& inputs) {
  constexpr size_t kMaxNames = 6;
  std::map<std::string, std::vector<std::string>> by_extension;
  for (const json& input : inputs) {
    const std::string file = input.at("file");
    by_extension[std::filesystem::path(file).extension().string()].push_back(file);
  }
  std::vector<std::string> words;
  for (auto& [extension, files] : by_extension) {
    const size_t count = files.size();
    if (count > kMaxNames) {
      words.push_back(fmt::format("{} {} files", count, extension));
    } else {
      words.insert(words.end(), files.begin(), files.end());
    }
  }
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

// Provenance of an artefact by its header: stage and software, inputs, and the settings that differ
// from the stage's defaults.
std::vector<Fact> Provenance(const json& header) {
  const json settings = header.value("settings", json::object());
  const std::string version =
      fmt::format("{}, schema version [{}]", header.value("software", "unknown software"),
                  fmt::join(header.at("schema_version").get<std::vector<int>>(), ", "));
  const Maker* maker = MakerOf(header.at("kind"), settings);
  if (maker == nullptr) return {{"made by", version}};
  return {{"made by", fmt::format("soslam-{} of {}", maker->stage, version)},
          {"from", InputsInWords(header.value("inputs", json::array()))},
          {"settings", SettingsInWords(settings, maker->defaults)}};
}

constexpr size_t kLineWidth = 100;

struct Kind {
  const char* name;
  const char* title;  // null: that of ArtefactKinds()
  Inspection (*of_document)(const json& document) = nullptr;
  Inspection (*of_file)(const std::filesystem::path& file) = nullptr;
};

constexpr std::array<Kind, 13> kKinds = {{
    {"associations", nullptr, &InspectAssociations},
    {"edges", "edges, distances and corners of images", nullptr, &InspectEdges},
    {"frames", nullptr, &InspectFrames},
    {"landmarks", nullptr, &InspectLandmarks},
    {"map", nullptr, &InspectMap},
    {"metrics", nullptr, &InspectMetrics},
    {"planes", nullptr, &InspectPlanes},
    {"points", "sparse points of structure from motion", nullptr, &InspectPoints},
    {"reconstruction", nullptr, nullptr, &InspectReconstruction},
    {"semantic_table", nullptr, nullptr, &InspectSemanticTable},
    {"sequence", nullptr, nullptr, &InspectSequence},
    {"symmetry", "what symmetry and edges say about the yaw of observations", nullptr,
     &InspectSymmetry},
    {"world", nullptr, nullptr, &InspectWorld},
}};

const Kind& FindKind(std::string_view name, const std::filesystem::path& file) {
  const auto* found = std::ranges::find(kKinds, name, &Kind::name);
  if (found != kKinds.end()) return *found;
  std::vector<std::string> known;
  for (const Kind& kind : kKinds) known.emplace_back(kind.name);
  throw InputError(fmt::format("{}: artefact kind is \"{}\"; expected one of {}", file.string(),
                               name, fmt::join(known, ", ")));
}

// Adds the labels of objects where the artefact has none.
void AddLabels(const Sequence& sequence, ValueTable* table) {
  const auto column = [&](const char* name) {
    const auto found = std::ranges::find(table->columns, name, &ValueColumn::name);
    return static_cast<size_t>(found - table->columns.begin());
  };
  const size_t object = column("object"), label = column("label");
  if (std::max(object, label) == table->columns.size()) return;
  for (std::vector<Value>& row : table->rows) {
    const auto found = std::ranges::find(sequence.objects, row[object].get<int>(), &Object::id);
    if (row[label].is_null() && found != sequence.objects.end()) row[label] = found->label;
  }
}

std::vector<Fact> FindingFacts(const std::filesystem::path& file) {
  std::vector<Fact> facts;
  if (IsHdf5(file)) return facts;
  for (const Finding& finding : FindingsOf(ParseJsonFile(file))) {
    facts.push_back(
        {kSeverityNames[static_cast<size_t>(finding.severity)], OneLine(InWords(finding))});
  }
  return facts;
}

}  // namespace

Inspection Inspect(const std::filesystem::path& file, const std::optional<Sequence>& sequence) {
  const nlohmann::json header = ReadArtefactHeader(file);
  const Kind& kind = FindKind(header.at("kind").get_ref<const std::string&>(), file);
  CheckArtefactHeader(header, kind.name, file.string());
  Inspection inspection = kind.of_file != nullptr ? kind.of_file(file)
                                                  : kind.of_document(ReadArtefact(file, kind.name));
  if (sequence) AddLabels(*sequence, &inspection.table);
  const std::string title = kind.title == nullptr ? FindArtefactKind(kind.name)->title : kind.title;
  inspection.title = fmt::format("{}: {} ({})", file.string(), kind.name, title);
  try {
    const std::vector<Fact> provenance = Provenance(header);
    inspection.facts.insert(inspection.facts.begin(), provenance.begin(), provenance.end());
    std::ranges::move(FindingFacts(file), std::back_inserter(inspection.facts));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{}: the artefact header is not as expected: {}", file.string(), error.what()));
  }
  return inspection;
}

std::string FormatInspection(const Inspection& inspection, bool is_coloured) {
  const auto styled = [&](fmt::emphasis emphasis, const std::string& text) {
    return is_coloured ? fmt::format(fmt::text_style(emphasis), "{}", text) : text;
  };
  size_t width = 0;
  for (const Fact& fact : inspection.facts) width = std::max(width, WidthOf(fact.name));
  std::string text = styled(fmt::emphasis::bold, inspection.title) + "\n";
  for (const Fact& fact : inspection.facts) {
    const std::string name = fact.name + std::string(width - WidthOf(fact.name), ' ');
    const size_t indent = 2 + width + 2;
    text += fmt::format("  {}  {}\n", styled(fmt::emphasis::faint, name),
                        Wrapped(fact.text, kLineWidth - indent, indent));
  }
  if (inspection.table.rows.empty()) return text;
  return text + "\n" + FormatTable(inspection.table, is_coloured);
}

std::map<std::string, int> CountsBy(const char* field, const json& rows) {
  std::map<std::string, int> counts;
  for (const json& row : rows) ++counts[row.at(field)];
  counts.erase("");
  return counts;
}

std::string FillIn(std::string_view text, const json& fields) {
  std::string filled;
  for (size_t begin = text.find('{'); begin != text.npos; begin = text.find('{')) {
    const size_t end = text.find('}', begin);
    const std::string_view hole = text.substr(begin + 1, end - begin - 1);
    const size_t colon = hole.find(':');
    const json& value = fields.at(json::json_pointer(fmt::format("/{}", hole.substr(0, colon))));
    filled += text.substr(0, begin);
    if (value.is_null()) {
      filled += kNoValue;
    } else if (value.is_string()) {
      filled += value.get<std::string>();
    } else if (colon == hole.npos) {
      filled += value.dump();
    } else {
      const std::string format = fmt::format("{{{}}}", hole.substr(colon));
      filled += fmt::format(fmt::runtime(format), value.get<double>());
    }
    text.remove_prefix(end + 1);
  }
  return filled += text;
}

}  // namespace soslam
