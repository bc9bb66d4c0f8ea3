// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/pipeline_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "artefact/json_file.h"
#include "association/options.h"
#include "base/error.h"
#include "base/options.h"
#include "base/paths.h"
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
  std::vector<std::string> needs;      // stages whose artefacts it reads
  std::set<std::string> other_inputs;  // arguments: "dataset" and "table"
  std::vector<StageOutput> outputs;
  // Its setting that asks for it unless it is "given"; null for a stage that 'stages' lists.
  const char* asked_by = nullptr;
};

const std::vector<PipelineStage>& Stages() {
  static const StageOutput sequence = {"output", "sequence.json"};
  static const std::vector<PipelineStage> stages = {
      {"import", &Resolve<ImportOptions>, {}, {"dataset"}, {sequence}},
      {"ground",
       &Resolve<GroundOptions>,
       {"import"},
       {"dataset", "table"},
       {sequence, {"world", "world.json"}},
       "ground"},
      {"associate",
       &Resolve<AssociateOptions>,
       {"import"},
       {"table"},
       {sequence, {"associations", "associations.json"}},
       "association"},
      {"planes",
       &Resolve<PlanesOptions>,
       {"import"},
       {"dataset", "table"},
       {sequence, {"report", "planes.json"}},
       "planes"},
      {"edges", &Resolve<EdgesOptions>, {"import"}, {"dataset"}, {{"output", "edges.h5"}}},
      {"track", &Resolve<TrackOptions>, {"import"}, {"dataset"}, {{"output", "points.h5"}}},
      {"initialise",
       &Resolve<InitialiseOptions>,
       {"import"},
       {"table"},
       {{"output", "initial.json"}}},
      {"refine",
       &Resolve<OrientationOptions>,
       {"import", "initialise", "edges"},
       {"table"},
       {{"output", "refined.json"}, {"curves", "symmetry.h5"}}},
      {"optimise",
       &Resolve<OptimiseOptions>,
       {"import", "initialise"},
       {"table"},
       {{"output", "map.json"}}},
      {"evaluate",
       &Resolve<EvaluateOptions>,
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

// Layers of the variant in `file`, preceded by those that it extends.
std::vector<json> ReadVariantLayers(fs::path file) {
  std::vector<json> layers;
  std::set<fs::path> seen;
  for (;;) {
    if (!seen.insert(file).second) {
      throw SettingsError(file.string() + ": 'extends' leads back to this file");
    }
    layers.push_back(ReadLayer(file));
    const json extends = layers.back().value("extends", json());
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
  json merged = ReadBaseLayer(pipelines / "base.json");
  const fs::path dataset_file = pipelines / "datasets" / (dataset + ".json");
  if (Exists(dataset_file)) merged.merge_patch(ReadBaseLayer(dataset_file));
  const std::vector<json> layers = ReadVariantLayers(variant_file);
  for (const json& layer : layers) merged.merge_patch(layer);

  const std::string file = variant_file.string();
  VariantSettings settings;
  CheckStageList(merged.value("stages", json()), file);
  const auto listed = merged.at("stages").get<std::set<std::string>>();
  settings.semantic_table = merged.value("semantic_table", "priors/semantic_table.json");
  for (const PipelineStage& stage : Stages()) {
    const bool is_listed = listed.contains(stage.name);
    if (!is_listed && stage.asked_by == nullptr) continue;
    const json resolved = stage.resolve(merged.value(stage.name, json::object()),
                                        fmt::format("{}: {}", file, stage.name));
    if (!is_listed && resolved.at(stage.asked_by) == "given") continue;
    settings.options[stage.name] = resolved;
  }
  CheckNeeds(settings, file);
  CheckSectionsAreUsed(settings, layers.back(), file);
  return settings;
}

}  // namespace soslam
