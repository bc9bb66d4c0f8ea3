// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/plan.h"

#include <algorithm>
#include <stdexcept>

#include "base/hash.h"
#include "workflow/pipeline_settings.h"

namespace soslam {
namespace {

using nlohmann::json;

// Digits of a key: enough to avoid collisions within a dataset, few enough to read.
constexpr size_t kKeyDigits = 10;

// Builds the chain of one variant, stage by stage.
class ChainBuilder {
 public:
  explicit ChainBuilder(const VariantSettings& settings) : settings_(settings) {}

  // The instances of all stages that the variant runs, in order.
  std::vector<StageInstance> Build() {
    for (const std::string& stage : PipelineStages()) {
      if (settings_.options.contains(stage)) Append(stage);
    }
    return std::move(chain_);
  }

 private:
  void Append(const std::string& stage) {
    StageInstance instance;
    instance.stage = stage;
    instance.settings = settings_.options.at(stage);
    instance.inputs = Inputs(stage);
    if (StageReads(stage, "table")) instance.semantic_table = settings_.semantic_table;
    instance.key = Key(instance);
    ids_[stage] = instance.Id();
    chain_.push_back(std::move(instance));
  }

  std::map<std::string, ArtefactSource> Inputs(const std::string& stage) const {
    if (stage == "import") return {};
    // Neither edge maps nor points depend on the world or its unit.
    if (stage == "edges" || stage == "track") return {{"sequence", Output("import")}};
    std::vector<std::string> makers = {"planes", "associate", "ground", "import"};
    const auto same = std::ranges::find(makers, stage);
    if (same != makers.end()) makers.erase(makers.begin(), std::next(same));
    std::map<std::string, ArtefactSource> inputs = {{"sequence", Latest(makers)}};
    const json& settings = settings_.options.at(stage);
    if (UsesImages(stage, settings)) inputs["edges"] = Output("edges");
    if (stage == "refine") inputs["initial"] = Output("initialise");
    if (UsesPoints(settings)) inputs["points"] = Output("track");
    if (stage == "optimise") inputs["landmarks"] = Latest({"refine", "initialise"});
    if (stage == "evaluate") inputs["landmarks"] = Latest({"optimise", "refine", "initialise"});
    return inputs;
  }

  ArtefactSource Output(const std::string& stage) const {
    return {ids_.at(stage), OutputsOfStage(stage).front().file};
  }

  // The output of the first of these stages that is in the variant.
  ArtefactSource Latest(const std::vector<std::string>& stages) const {
    const auto found = std::ranges::find_if(
        stages, [&](const std::string& stage) { return ids_.contains(stage); });
    if (found == stages.end()) throw std::logic_error("no stage that gives this input");
    return Output(*found);
  }

  static std::string Key(const StageInstance& instance) {
    json inputs = json::object();
    for (const auto& [argument, source] : instance.inputs) inputs[argument] = source.instance;
    if (!instance.semantic_table.empty()) inputs["table"] = instance.semantic_table;
    const json identity = {
        {"stage", instance.stage}, {"settings", instance.settings}, {"inputs", inputs}};
    return Sha256OfText(identity.dump()).substr(0, kKeyDigits);
  }

  const VariantSettings& settings_;
  std::map<std::string, std::string> ids_;  // keyed by stage
  std::vector<StageInstance> chain_;
};

}  // namespace

const StageInstance& Plan::Instance(const std::string& id) const {
  const auto found = std::ranges::find_if(
      instances, [&](const StageInstance& instance) { return instance.Id() == id; });
  if (found == instances.end()) throw std::out_of_range("no instance " + id);
  return *found;
}

std::vector<std::filesystem::path> PrerequisitesOf(const StageInstance& instance,
                                                   const PlanFolders& folders) {
  std::vector<std::filesystem::path> files = {
      folders.executables / ("soslam-" + instance.stage),
      folders.results / InstancePath(instance.Id(), "settings.json")};
  for (const auto& [argument, source] : instance.inputs) {
    files.push_back(folders.results / InstancePath(source.instance, source.file));
  }
  if (instance.stage == "import") files.push_back(folders.results / kDatasetListing);
  if (StageReads(instance.stage, "dataset")) files.push_back(folders.results / kImagesListing);
  if (!instance.semantic_table.empty()) {
    files.push_back(folders.pipelines / instance.semantic_table);
  }
  return files;
}

std::string InstancePath(const std::string& instance, const std::string& file) {
  return "shared/" + instance + "/" + file;
}

Plan MakePlan(const std::filesystem::path& pipelines, const std::string& dataset,
              const std::vector<std::string>& variants) {
  Plan plan;
  for (const std::string& variant : variants) {
    const VariantSettings settings = ReadVariant(pipelines, dataset, variant);
    VariantChain chain{variant, {}};
    for (StageInstance& instance : ChainBuilder(settings).Build()) {
      const std::string id = instance.Id();
      chain.instances.push_back(id);
      auto known = std::ranges::find_if(
          plan.instances, [&](const StageInstance& other) { return other.Id() == id; });
      if (known == plan.instances.end()) {
        known = plan.instances.insert(known, std::move(instance));
      }
      known->variants.push_back(variant);
    }
    plan.variants.push_back(std::move(chain));
  }
  return plan;
}

}  // namespace soslam
