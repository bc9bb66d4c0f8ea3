// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/pipeline_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/cli/command_line.h"
#include "soslam/report/results_tree.h"
#include "soslam/workflow/pipeline_stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A file of settings of stages.
struct SettingsOfFile {
  std::filesystem::path file;
  nlohmann::json settings;
};

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

bool HasSetting(const PipelineStage& stage, const std::string& name) {
  const auto rows = stage.rows();
  return std::ranges::find(rows, name, &OptionRow::name) != rows.end();
}

// Throws SettingsError if only other stages have a setting of this name. `stage` is the one in
// whose section the setting is; null outside of sections.
void RefuseOfOtherStages(const std::string& name, const PipelineStage* stage,
                         const std::string& where) {
  if (stage != nullptr && HasSetting(*stage, name)) return;
  std::vector<std::string> stages;
  for (const PipelineStage& other : Stages()) {
    if (HasSetting(other, name)) stages.emplace_back(other.name);
  }
  if (stages.empty()) return;
  throw SettingsError(fmt::format("{}: '{}' is a setting of {}; expected it in the section {}",
                                  where, name, fmt::join(stages, ", "),
                                  stages.size() == 1 ? "of this stage" : "of one of these stages"));
}

// Reads a file and checks it separately, so that a message can name it.
json ReadLayer(const fs::path& path) {
  json layer = ReadSettingsFile(path);
  const std::string file = path.string();
  for (const auto& [key, value] : layer.items()) {
    if (value.is_null()) continue;  // null in a merge patch removes the value of a lower layer
    if (const PipelineStage* stage = FindStage(key)) {
      json without_nulls = json::object();
      if (value.is_object()) without_nulls.merge_patch(value);
      for (const auto& setting : without_nulls.items()) {
        RefuseOfOtherStages(setting.key(), stage, file + ": " + key);
      }
      stage->resolve(value.is_object() ? without_nulls : value, file + ": " + key);
    } else if (key == "stages") {
      CheckStageList(value, file);
    } else if (key == "description" || key == "semantic_table" || key == "extends") {
      if (!value.is_string()) {
        throw SettingsError(
            fmt::format("{}: '{}' is {}; expected a string", file, key, value.dump()));
      }
    } else if (key == "about") {
      try {
        ReadDocument<DatasetFacts>(value, file + ": about");
      } catch (const InputError& error) {
        throw SettingsError(error.what());
      }
    } else {
      RefuseOfOtherStages(key, nullptr, file);
      throw SettingsError(fmt::format(
          "{}: unknown key '{}'; known are description, about, extends, stages, semantic_table and "
          "the stages {}",
          file, key, fmt::join(PipelineStages(), ", ")));
    }
  }
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
std::vector<SettingsOfFile> ReadVariantLayers(fs::path file) {
  std::vector<SettingsOfFile> layers;
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
  for (const auto& [name, options] : settings.options) {
    for (const StageInput& input : FindStage(name)->inputs) {
      // The last of the makers; the others read what it writes.
      const std::string& needed = input.makers.back();
      const std::optional<std::string> asking = AskingSetting(input, options);
      if (!asking || settings.options.contains(needed)) continue;
      throw SettingsError(fmt::format("{}: stage '{}'{}{} needs stage '{}' in 'stages'", file, name,
                                      asking->empty() ? "" : " with ", *asking, needed));
    }
  }
}

// Resolved options of the stages that run.
StageOptions ResolveOptions(const json& merged, const std::string& file) {
  const auto listed = merged.at("stages").get<std::set<std::string>>();
  const auto resolve = [&](const PipelineStage& stage) {
    return stage.resolve(merged.value(stage.name, json::object()),
                         fmt::format("{}: {}", file, stage.name));
  };
  StageOptions options;
  std::set<std::string> added;
  for (const PipelineStage& stage : Stages()) {
    const bool is_listed = listed.contains(stage.name);
    if (!is_listed && stage.asked_by == nullptr) continue;
    const json resolved = resolve(stage);
    if (!is_listed && resolved.at(stage.asked_by) == "given") continue;
    options[stage.name] = resolved;
    for (const StageInput& input : stage.inputs) {
      if (input.adds_maker && AskingSetting(input, resolved)) added.insert(input.makers.back());
    }
  }
  for (const std::string& name : added) options[name] = resolve(*FindStage(name));
  return options;
}

// The conditions that a setting lacks to have an effect. None if it has one, or if its stage runs
// only in other variants, which list it in 'stages'.
OptionVisitor::Conditions FindUnmetConditions(const PipelineStage& stage, const std::string& name,
                                              const StageOptions& options) {
  const std::vector<OptionRow> rows = stage.rows();
  const auto of_stage = options.find(stage.name);
  if (of_stage != options.end()) return UnmetConditions(rows, of_stage->second, name);
  if (stage.asked_by == nullptr || name == stage.asked_by) return {};
  auto unmet = UnmetConditions(rows, stage.resolve(json::object(), stage.name), name);
  if (!unmet.empty()) return unmet;
  std::vector<std::string> asking =
      std::ranges::find(rows, stage.asked_by, &OptionRow::name)->choices;
  std::erase(asking, "given");
  return {{stage.asked_by, asking}};
}

// Adds the findings on settings without effect of a variant's own file, or of the file of the
// dataset, to those of the variant. A variant is for all datasets: one may rule out what it has for
// others. The settings of a dataset are for all variants, unless they rule out each other. `alone`
// are the options without the dataset's file, or with that file only.
void CheckUnusedSettings(const SettingsOfFile& layer, const StageOptions& alone, bool is_of_dataset,
                         VariantSettings* settings) {
  for (const auto& section : layer.settings.items()) {
    const std::string& key = section.key();
    const json& values = section.value();
    const PipelineStage* stage = FindStage(key);
    if (stage == nullptr || !values.is_object()) continue;
    for (const auto& [name, value] : values.items()) {
      const auto unmet = FindUnmetConditions(*stage, name, settings->options);
      if (value.is_null() || unmet.empty()) continue;
      const Finding finding =
          SettingWithoutEffect(layer.file.string() + ": " + key, name, value, unmet);
      const bool is_said = !is_of_dataset || std::ranges::any_of(unmet, [&](const auto& condition) {
        return values.contains(condition.option);
      });
      if (is_said && !FindUnmetConditions(*stage, name, alone).empty()) {
        settings->findings.push_back(finding);
      } else if (is_of_dataset && !settings->options.contains(key)) {
        settings->for_others.push_back(finding);
      }
    }
  }
}

}  // namespace

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
  const SettingsOfFile of_dataset = {
      dataset_file, Exists(dataset_file) ? ReadBaseLayer(dataset_file) : json::object()};
  std::vector<SettingsOfFile> layers = {{base_file, ReadBaseLayer(base_file)}, of_dataset};
  std::ranges::move(ReadVariantLayers(variant_file), std::back_inserter(layers));

  VariantSettings settings;
  json merged = json::object(), without_dataset = merged, dataset_alone = merged;
  for (const SettingsOfFile& layer : layers) {
    merged.merge_patch(layer.settings);
    (layer.file == dataset_file ? dataset_alone : without_dataset).merge_patch(layer.settings);
    if (layer.settings.contains("semantic_table") || settings.semantic_table_file.empty()) {
      settings.semantic_table_file = layer.file.string();
    }
  }
  const std::string file = variant_file.string();
  CheckStageList(merged.value("stages", json()), file);
  settings.semantic_table = merged.value("semantic_table", "priors/semantic_table.json");
  settings.options = ResolveOptions(merged, file);
  CheckNeeds(settings, file);
  // The variant's own settings of a stage that it does not run would change nothing, without a
  // word.
  for (const auto& [key, value] : layers.back().settings.items()) {
    const PipelineStage* stage = FindStage(key);
    if (stage == nullptr || value.is_null() || settings.options.contains(key)) continue;
    if (stage->asked_by != nullptr && value.contains(stage->asked_by)) continue;
    throw SettingsError(
        fmt::format("{}: has settings of stage '{}', which does not run", file, key));
  }
  without_dataset["stages"] = dataset_alone["stages"] = merged.at("stages");
  CheckUnusedSettings(layers.back(), ResolveOptions(without_dataset, file), false, &settings);
  CheckUnusedSettings(of_dataset, ResolveOptions(dataset_alone, file), true, &settings);
  return settings;
}

}  // namespace soslam
