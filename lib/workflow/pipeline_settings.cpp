// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/pipeline_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "artefact/json_file.h"
#include "association/options.h"
#include "base/error.h"
#include "base/options.h"
#include "base/paths.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "dataset/import_options.h"
#include "evaluation/alignment.h"
#include "ground/options.h"
#include "image/edge_maps.h"
#include "image/feature_tracks.h"
#include "initialisation/options.h"
#include "mapping/options.h"
#include "orientation/options.h"
#include "planes/options.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Defaults of an options struct overwritten by `values`.
template <typename Options>
json Resolve(const json& values, const std::string& where) {
  Options options;
  OptionsFromJson(values, where, &options);
  return OptionsToJson(options);
}

struct PipelineStage {
  const char* name;
  json (*resolve)(const json& values, const std::string& where);
  std::vector<OptionRow> (*rows)();
  std::vector<std::string> needs;      // stages whose artefacts it reads
  std::set<std::string> other_inputs;  // arguments: "dataset" and "table"
  std::vector<StageOutput> outputs;
  // Its setting that asks for it unless it is "given"; null for a stage that 'stages' lists.
  const char* asked_by = nullptr;
};

const std::vector<PipelineStage>& Stages() {
  static const StageOutput sequence = {"output", "sequence.json"};
  static const std::vector<PipelineStage> stages = {
      {"import", &Resolve<ImportOptions>, &OptionRows<ImportOptions>, {}, {"dataset"}, {sequence}},
      {"ground",
       &Resolve<GroundOptions>,
       &OptionRows<GroundOptions>,
       {"import"},
       {"dataset", "table"},
       {sequence, {"world", "world.json"}},
       "ground"},
      {"associate",
       &Resolve<AssociateOptions>,
       &OptionRows<AssociateOptions>,
       {"import"},
       {"table"},
       {sequence, {"associations", "associations.json"}},
       "association"},
      {"planes",
       &Resolve<PlanesOptions>,
       &OptionRows<PlanesOptions>,
       {"import"},
       {"dataset", "table"},
       {sequence, {"report", "planes.json"}},
       "planes"},
      {"edges",
       &Resolve<EdgesOptions>,
       &OptionRows<EdgesOptions>,
       {"import"},
       {"dataset"},
       {{"output", "edges.h5"}}},
      {"track",
       &Resolve<TrackOptions>,
       &OptionRows<TrackOptions>,
       {"import"},
       {"dataset"},
       {{"output", "points.h5"}}},
      {"initialise",
       &Resolve<InitialiseOptions>,
       &OptionRows<InitialiseOptions>,
       {"import"},
       {"table"},
       {{"output", "initial.json"}}},
      {"refine",
       &Resolve<OrientationOptions>,
       &OptionRows<OrientationOptions>,
       {"import", "initialise", "edges"},
       {"table"},
       {{"output", "refined.json"}, {"curves", "symmetry.h5"}}},
      {"optimise",
       &Resolve<OptimiseOptions>,
       &OptionRows<OptimiseOptions>,
       {"import", "initialise"},
       {"table"},
       {{"output", "map.json"}}},
      {"evaluate",
       &Resolve<EvaluateOptions>,
       &OptionRows<EvaluateOptions>,
       {"import", "initialise"},
       {},
       {{"output", "metrics.json"}}}};
  return stages;
}

const PipelineStage* FindStage(const std::string& name) {
  const auto found = std::ranges::find(Stages(), name, &PipelineStage::name);
  return found == Stages().end() ? nullptr : &*found;
}

void CheckStageList(const json& stages, const std::string& file) {
  std::set<std::string> seen;
  if (!stages.is_array() || stages.empty()) {
    throw SettingsError(file + ": 'stages' is " + stages.dump() + "; expected a list of stages");
  }
  std::vector<std::string> listed;
  for (const PipelineStage& stage : Stages()) {
    if (stage.asked_by == nullptr) listed.emplace_back(stage.name);
  }
  for (const json& stage : stages) {
    if (!stage.is_string() || std::ranges::find(listed, stage.get<std::string>()) == listed.end()) {
      throw SettingsError(fmt::format("{}: 'stages' has {}; expected one of {}", file, stage.dump(),
                                      fmt::join(listed, ", ")));
    }
    if (!seen.insert(stage).second) {
      throw SettingsError(fmt::format("{}: 'stages' has {} twice", file, stage.dump()));
    }
  }
}

// Checks one file separately, so that a message can name it.
void CheckLayer(const json& layer, const std::string& file) {
  for (const auto& [key, value] : layer.items()) {
    if (value.is_null()) continue;  // null in a merge patch removes the value of a lower layer
    if (const PipelineStage* stage = FindStage(key)) {
      json without_nulls = json::object();
      if (value.is_object()) without_nulls.merge_patch(value);
      stage->resolve(value.is_object() ? without_nulls : value, file + ": " + key);
    } else if (key == "stages") {
      CheckStageList(value, file);
    } else if (key == "description" || key == "semantic_table" || key == "extends") {
      if (!value.is_string()) {
        throw SettingsError(
            fmt::format("{}: '{}' is {}; expected a string", file, key, value.dump()));
      }
    } else if (key == "about") {
      if (const auto violation = SchemaViolation(value, "about")) {
        throw SettingsError(fmt::format("{}: about: {}", file, *violation));
      }
    } else {
      throw SettingsError(fmt::format(
          "{}: unknown key '{}'; known are description, about, extends, stages, semantic_table and "
          "the stages {}",
          file, key, fmt::join(PipelineStages(), ", ")));
    }
  }
}

json ReadLayer(const fs::path& file) {
  json layer = ReadSettingsFile(file);
  CheckLayer(layer, file.string());
  return layer;
}

// Reads a layer shared by all variants.
json ReadBaseLayer(const fs::path& file) {
  json layer = ReadLayer(file);
  if (layer.contains("extends")) {
    throw SettingsError(file.string() + ": 'extends' is for variants only");
  }
  return layer;
}

struct Layer {
  fs::path file;
  json settings;
};

// Layers of the variant in `file`, preceded by those that it extends.
std::vector<Layer> ReadVariantLayers(fs::path file) {
  std::vector<Layer> layers;
  std::set<fs::path> seen;
  for (;;) {
    if (!seen.insert(file).second) {
      throw SettingsError(file.string() + ": 'extends' leads back to this file");
    }
    layers.push_back({file, ReadLayer(file)});
    const json extends = layers.back().settings.value("extends", json());
    if (extends.is_null()) break;
    const fs::path extended =
        (file.parent_path() / (extends.get<std::string>() + ".json")).lexically_normal();
    if (!Exists(extended)) {
      throw SettingsError(fmt::format("{}: 'extends' is {}, but {} does not exist", file.string(),
                                      extends.dump(), extended.string()));
    }
    file = extended;
  }
  std::reverse(layers.begin(), layers.end());
  return layers;
}

void CheckNeeds(const VariantSettings& settings, const std::string& file) {
  const auto need = [&](const std::string& who, const std::string& stage) {
    if (settings.options.contains(stage)) return;
    throw SettingsError(fmt::format("{}: {} stage '{}' in 'stages'", file, who, stage));
  };
  for (const auto& [name, options] : settings.options) {
    for (const std::string& needed : FindStage(name)->needs) {
      need(fmt::format("stage '{}' needs", name), needed);
    }
  }
  const std::pair<const char*, const char*> users_of_images[] = {
      {"initialise", "setting 'method' = cuboid_proposals of initialise needs"},
      {"optimise", "settings 'symmetry' and 'edge_alignment' of optimise need"}};
  for (const auto& [stage, who] : users_of_images) {
    const auto used = settings.options.find(stage);
    if (used != settings.options.end() && UsesImages(stage, used->second)) need(who, "edges");
  }
  for (const auto& [stage, options] : settings.options) {
    if (UsesPoints(options)) {
      need(fmt::format("setting 'point_evidence' of {} needs", stage), "track");
    }
  }
}

// A variant's own settings of a stage that it does not run would change nothing, without a word.
void CheckSectionsAreUsed(const VariantSettings& settings, const json& own_layer,
                          const std::string& file) {
  for (const auto& [key, value] : own_layer.items()) {
    const PipelineStage* stage = FindStage(key);
    if (stage == nullptr || value.is_null() || settings.options.contains(key)) continue;
    if (stage->asked_by != nullptr && value.contains(stage->asked_by)) continue;
    throw SettingsError(
        fmt::format("{}: has settings of stage '{}', which does not run", file, key));
  }
}

using StageOptions = std::map<std::string, json>;

// Resolved options of the stages that run.
StageOptions OptionsOf(const json& merged, const std::string& file) {
  const auto listed = merged.at("stages").get<std::set<std::string>>();
  StageOptions options;
  for (const PipelineStage& stage : Stages()) {
    const bool is_listed = listed.contains(stage.name);
    if (!is_listed && stage.asked_by == nullptr) continue;
    const json resolved = stage.resolve(merged.value(stage.name, json::object()),
                                        fmt::format("{}: {}", file, stage.name));
    if (is_listed || resolved.at(stage.asked_by) != "given") options[stage.name] = resolved;
  }
  return options;
}

// What a setting would need to have an effect; empty if it has one, or is for other variants, whose
// 'stages' list its stage.
OptionVisitor::Conditions UnmetConditionsOf(const PipelineStage& stage, const std::string& name,
                                            const StageOptions& options) {
  const std::vector<OptionRow> rows = stage.rows();
  const auto of_stage = options.find(stage.name);
  if (of_stage != options.end()) return UnmetConditions(rows, of_stage->second, name);
  if (stage.asked_by == nullptr || name == stage.asked_by) return {};
  const auto unmet = UnmetConditions(rows, stage.resolve(json::object(), stage.name), name);
  if (!unmet.empty()) return unmet;
  std::vector<std::string> asking =
      std::ranges::find(rows, stage.asked_by, &OptionRow::name)->choices;
  std::erase(asking, "given");
  return {{stage.asked_by, asking}};
}

// A setting without effect.
struct Unused {
  const PipelineStage* stage;
  std::string name;
  OptionVisitor::Conditions unmet;
  Finding finding;
};

std::vector<Unused> UnusedOf(const Layer& layer, const StageOptions& options) {
  std::vector<Unused> found;
  for (const auto& [key, values] : layer.settings.items()) {
    const PipelineStage* stage = FindStage(key);
    if (stage == nullptr || !values.is_object()) continue;
    for (const auto& [name, value] : values.items()) {
      const auto unmet = UnmetConditionsOf(*stage, name, options);
      if (value.is_null() || unmet.empty()) continue;
      found.push_back({stage, name, unmet,
                       SettingWithoutEffect(layer.file.string() + ": " + key, name, value, unmet)});
    }
  }
  return found;
}

// Adds the findings on a variant's own settings. It is for all datasets: one may rule out what it
// has for others.
void CheckOwnSettings(const Layer& own, const StageOptions& without_dataset,
                      VariantSettings* settings) {
  for (const Unused& unused : UnusedOf(own, settings->options)) {
    if (UnmetConditionsOf(*unused.stage, unused.name, without_dataset).empty()) continue;
    settings->findings.push_back(unused.finding);
  }
}

// Adds the findings on the settings of a dataset, which are for all variants, unless they rule out
// each other.
void CheckSettingsOfDataset(const Layer& of_dataset, const StageOptions& alone,
                            VariantSettings* settings) {
  for (const Unused& unused : UnusedOf(of_dataset, settings->options)) {
    const json& section = of_dataset.settings.at(unused.stage->name);
    const bool is_said = std::ranges::any_of(
        unused.unmet, [&](const auto& condition) { return section.contains(condition.option); });
    if (is_said && !UnmetConditionsOf(*unused.stage, unused.name, alone).empty()) {
      settings->findings.push_back(unused.finding);
    } else if (!settings->options.contains(unused.stage->name)) {
      settings->for_others.push_back(unused.finding);
    }
  }
}

}  // namespace

std::vector<StageOutput> OutputsOfStage(const std::string& stage) {
  const PipelineStage* found = FindStage(stage);
  return found == nullptr ? std::vector<StageOutput>() : found->outputs;
}

bool StageReads(const std::string& stage, const std::string& input) {
  const PipelineStage* found = FindStage(stage);
  return found != nullptr && found->other_inputs.contains(input);
}

bool UsesImages(const std::string& stage, const json& settings) {
  if (stage == "initialise") return settings.at("method") == "cuboid_proposals";
  if (stage == "optimise") {
    return settings.at("symmetry") == true || settings.at("edge_alignment") == true;
  }
  return stage == "refine";
}

bool UsesPoints(const json& settings) { return settings.value("point_evidence", false); }

std::vector<std::string> PipelineStages() {
  std::vector<std::string> names;
  for (const PipelineStage& stage : Stages()) names.emplace_back(stage.name);
  return names;
}

std::vector<std::string> VariantNames(const fs::path& pipelines) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(pipelines / "variants", error)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  if (names.empty()) {
    throw SettingsError((pipelines / "variants").string() + ": no variants; expected <name>.json");
  }
  std::ranges::sort(names);
  return names;
}

VariantSettings ReadVariant(const fs::path& pipelines, const std::string& dataset,
                            const std::string& variant) {
  const fs::path variant_file = pipelines / "variants" / (variant + ".json");
  if (!Exists(variant_file)) {
    throw SettingsError(fmt::format("{}: no such variant; known are {}", variant_file.string(),
                                    fmt::join(VariantNames(pipelines), ", ")));
  }
  const fs::path base_file = pipelines / "base.json";
  const fs::path dataset_file = pipelines / "datasets" / (dataset + ".json");
  const Layer of_dataset = {dataset_file,
                            Exists(dataset_file) ? ReadBaseLayer(dataset_file) : json::object()};
  std::vector<Layer> layers = {{base_file, ReadBaseLayer(base_file)}, of_dataset};
  std::ranges::move(ReadVariantLayers(variant_file), std::back_inserter(layers));

  VariantSettings settings;
  json merged = json::object(), without_dataset = merged, dataset_alone = merged;
  for (const Layer& layer : layers) {
    merged.merge_patch(layer.settings);
    (layer.file == dataset_file ? dataset_alone : without_dataset).merge_patch(layer.settings);
    if (layer.settings.contains("semantic_table") || settings.semantic_table_file.empty()) {
      settings.semantic_table_file = layer.file.string();
    }
  }
  const std::string file = variant_file.string();
  CheckStageList(merged.value("stages", json()), file);
  settings.semantic_table = merged.value("semantic_table", "priors/semantic_table.json");
  settings.options = OptionsOf(merged, file);
  CheckNeeds(settings, file);
  CheckSectionsAreUsed(settings, layers.back().settings, file);
  without_dataset["stages"] = dataset_alone["stages"] = merged.at("stages");
  CheckOwnSettings(layers.back(), OptionsOf(without_dataset, file), &settings);
  CheckSettingsOfDataset(of_dataset, OptionsOf(dataset_alone, file), &settings);
  return settings;
}

std::vector<Finding> CheckNamesOfSettings(const fs::path& pipelines, const std::string& dataset) {
  const fs::path expected = pipelines / "datasets" / (dataset + ".json");
  if (Exists(expected)) return {};
  const std::set<std::string> endings = {".json", ".jsonc", ".json5", ".txt"};
  std::vector<Finding> findings;
  std::error_code error;  // there are no settings of datasets at all
  for (const auto& entry : fs::directory_iterator(expected.parent_path(), error)) {
    fs::path name = LowerCase(entry.path().filename().string());
    while (endings.contains(name.extension().string())) name = name.stem();
    if (name != LowerCase(dataset)) continue;
    findings.push_back({"name_of_settings", Severity::kWarning,
                        fmt::format("{} is not read", entry.path().string()),
                        fmt::format("the settings of dataset {} in {}", dataset, expected.string()),
                        "another case or ending of the name; some systems hide endings",
                        "rename the file"});
  }
  return findings;
}

}  // namespace soslam
