// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/system/hash.h"
#include "soslam/workflow/pipeline_settings.h"
#include "soslam/workflow/pipeline_stages.h"

namespace soslam {
namespace {

using nlohmann::json;

// Digits of a key: enough to avoid collisions within a dataset, few enough to read.
constexpr size_t kKeyDigits = 10;

// Ids of instances of one variant, keyed by stage.
using InstanceIds = std::map<std::string, std::string>;

StageInstance MakeInstance(const std::string& stage, const VariantSettings& settings,
                           const InstanceIds& before, bool has_edits) {
  StageInstance instance;
  instance.stage = stage;
  instance.settings = settings.options.at(stage);
  const PipelineStage& described = *FindStage(stage);
  for (const StageInput& input : described.inputs) {
    if (!AskingSetting(input, instance.settings)) continue;
    const auto maker = std::ranges::find_if(
        input.makers, [&](const std::string& name) { return before.contains(name); });
    if (maker == input.makers.end()) {
      throw std::logic_error(stage + " lacks an input, which CheckNeeds refuses");
    }
    instance.inputs[input.argument] = {before.at(*maker), OutputsOfStage(*maker).front().file};
  }
  if (described.other_inputs.contains("table")) instance.semantic_table = settings.semantic_table;
  json inputs = json::object();
  for (const auto& [argument, source] : instance.inputs) inputs[argument] = source.instance;
  if (!instance.semantic_table.empty()) inputs["table"] = instance.semantic_table;
  instance.reads_edits = has_edits && described.takes_edits;
  if (instance.reads_edits) inputs["edits"] = kEditsFile;
  const json identity = {{"stage", stage}, {"settings", instance.settings}, {"inputs", inputs}};
  instance.key = Sha256OfText(identity.dump()).substr(0, kKeyDigits);
  return instance;
}

// Files in pipelines/datasets that are not read because of the case or the ending of their names,
// where the dataset has no settings: Room.json, room.json.txt.
std::vector<Finding> CheckNamesOfSettings(const std::filesystem::path& pipelines,
                                          const std::string& dataset) {
  const std::filesystem::path expected = pipelines / "datasets" / (dataset + ".json");
  if (Exists(expected)) return {};
  const std::set<std::string> endings = {".json", ".jsonc", ".json5", ".txt"};
  std::vector<Finding> findings;
  std::error_code error;  // there are no settings of datasets at all
  for (const auto& entry : std::filesystem::directory_iterator(expected.parent_path(), error)) {
    std::filesystem::path name = LowerCase(entry.path().filename().string());
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

// True if some variant of the pipelines runs the stage of a setting of the dataset, or cannot be
// read.
bool IsForAVariant(const Finding& setting, const std::filesystem::path& pipelines,
                   const std::string& dataset) {
  return std::ranges::any_of(VariantNames(pipelines), [&](const std::string& variant) {
    try {
      const std::vector<Finding> unused = ReadVariant(pipelines, dataset, variant).for_others;
      return std::ranges::find(unused, setting) == unused.end();
    } catch (const SettingsError&) {
      return true;
    }
  });
}

}  // namespace

const StageInstance& Plan::Instance(const std::string& id) const {
  const auto found = std::ranges::find(instances, id, &StageInstance::Id);
  if (found == instances.end()) throw std::out_of_range("no instance " + id);
  return *found;
}

std::vector<std::filesystem::path> ListPrerequisites(const StageInstance& instance,
                                                     const PlanFolders& folders) {
  std::vector<std::filesystem::path> files = {
      folders.executables / ("soslam-" + instance.stage),
      folders.results / InstancePath(instance.Id(), "settings.json")};
  for (const auto& [argument, source] : instance.inputs) {
    files.push_back(folders.results / InstancePath(source.instance, source.file));
  }
  if (instance.stage == "import") files.push_back(folders.results / kDatasetListing);
  if (FindStage(instance.stage)->other_inputs.contains("dataset")) {
    files.push_back(folders.results / kImagesListing);
  }
  if (FindStage(instance.stage)->other_inputs.contains("head")) {
    files.push_back(folders.pipelines / kHeadFile);
  }
  if (!instance.semantic_table.empty()) {
    files.push_back(folders.pipelines / instance.semantic_table);
  }
  if (instance.reads_edits) files.push_back(folders.results / kEditsFile);
  return files;
}

std::string InstancePath(const std::string& instance, const std::string& file) {
  return "shared/" + instance + "/" + file;
}

Plan MakePlan(const std::filesystem::path& pipelines, const std::string& dataset,
              const std::vector<std::string>& variants, bool has_edits) {
  Plan plan;
  plan.findings = CheckNamesOfSettings(pipelines, dataset);
  std::vector<Finding> for_others;
  for (const std::string& variant : variants) {
    const VariantSettings settings = ReadVariant(pipelines, dataset, variant);
    const std::filesystem::path table = pipelines / settings.semantic_table;
    if (!Exists(table)) {
      throw InputError(
          fmt::format("{}: 'semantic_table' is \"{}\", but {} does not exist; expected the path of "
                      "a table from {}",
                      settings.semantic_table_file, settings.semantic_table, table.string(),
                      pipelines.string()));
    }
    const std::filesystem::path head = pipelines / kHeadFile;
    if (settings.options.contains("appearance") && !Exists(head)) {
      throw InputError(
          fmt::format("{}: does not exist; variant '{}' runs the stage appearance, which needs it: "
                      "copy it from pipelines/pictures",
                      head.string(), variant));
    }
    std::ranges::copy(settings.findings, std::back_inserter(plan.findings));
    std::ranges::copy(settings.for_others, std::back_inserter(for_others));
    VariantChain chain{variant, {}};
    InstanceIds ids;
    for (const std::string& stage : PipelineStages()) {
      if (!settings.options.contains(stage)) continue;
      StageInstance instance = MakeInstance(stage, settings, ids, has_edits);
      ids[stage] = instance.Id();
      chain.instances.push_back(instance.Id());
      auto known = std::ranges::find(plan.instances, instance.Id(), &StageInstance::Id);
      if (known == plan.instances.end()) {
        known = plan.instances.insert(known, std::move(instance));
      }
      known->variants.push_back(variant);
    }
    plan.variants.push_back(std::move(chain));
  }
  for (const Finding& setting : WorstFirst(std::move(for_others))) {
    if (!IsForAVariant(setting, pipelines, dataset)) plan.findings.push_back(setting);
  }
  plan.findings = WorstFirst(std::move(plan.findings));
  return plan;
}

}  // namespace soslam
