// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/file_kind.h"
#include "stage/run_plan.h"
#include "workflow/pipeline_settings.h"
#include "workflow/plan_state.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> PlannedDatasets(const fs::path& results) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(results, error)) {
    if (Exists(entry.path() / "plan.mk")) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

// Plan and states of one dataset's runs.
class Status {
 public:
  Status(std::string name, const StatusOptions& options, const StageFiles& files,
         const StagesUnderWay& under_way)
      : name_(std::move(name)), folders_(ReadPlanFolders(files.at("results") / name_ / "plan.mk")) {
    folders_.results = files.at("results") / name_;
    // Plans again, so that changed settings and files count; without the dataset the last plan is
    // used.
    const std::vector<std::string> planned = PlannedVariants(folders_.pipelines, folders_.results);
    if (IsFolder(folders_.dataset) && !planned.empty()) {
      RunPlan({.name = name_, .variants = fmt::format("{}", fmt::join(planned, " "))},
              {{"dataset", folders_.dataset},
               {"pipelines", folders_.pipelines},
               {"results", files.at("results")}},
              1);
    }
    plan_ = MakePlan(folders_.pipelines, name_, Variants(options));
    states_ = StatesOf(plan_, folders_, files.at("executables"), under_way);
  }

  void PrintTable() const {
    std::vector<std::string> stages = PipelineStages();
    std::erase_if(stages, [this](const std::string& stage) {
      return std::ranges::none_of(
          plan_.instances, [&](const StageInstance& instance) { return instance.stage == stage; });
    });
    PrintRow(name_, stages);
    for (const VariantChain& variant : plan_.variants) {
      std::vector<std::string> cells;
      for (const std::string& stage : stages) {
        const StageInstance* instance = Find(variant, stage);
        cells.emplace_back(instance == nullptr ? "-" : NameOf(StateOf(*instance).state));
      }
      PrintRow("  " + variant.name, cells);
    }
    for (const StageInstance& instance : plan_.instances) {
      const InstanceState& state = StateOf(instance);
      if (state.state == StageState::kFailed) {
        fmt::print("  {}: {}\n", instance.Id(), state.reasons.front());
      }
    }
  }

  // Prints each instance of the stage once, followed by the earlier ones that have to run.
  void PrintReasons(const std::string& stage) const {
    std::set<std::string> printed;
    for (const VariantChain& variant : plan_.variants) {
      const StageInstance* instance = Find(variant, stage);
      if (instance == nullptr) {
        fmt::print("{}: {} has no stage {}\n", name_, variant.name, stage);
      } else {
        PrintReasons(variant, *instance, &printed);
      }
    }
  }

 private:
  std::vector<std::string> Variants(const StatusOptions& options) const {
    const std::vector<std::string> variants = SplitAtSpaces(options.variants);
    if (!variants.empty()) return variants;
    if (!IsFolder(folders_.dataset)) return PlannedVariants(folders_.pipelines, folders_.results);
    return PossibleVariants(folders_.pipelines, name_, folders_.dataset);
  }

  const InstanceState& StateOf(const StageInstance& instance) const {
    return states_.at(instance.Id());
  }

  const StageInstance* Find(const VariantChain& variant, const std::string& stage) const {
    for (const std::string& id : variant.instances) {
      const StageInstance& instance = plan_.Instance(id);
      if (instance.stage == stage) return &instance;
    }
    return nullptr;
  }

  static void PrintRow(const std::string& first, const std::vector<std::string>& cells) {
    fmt::print("{:<16}", first);
    for (const std::string& cell : cells) fmt::print(" {:<10}", cell);
    fmt::print("\n");
  }

  void PrintReasons(const VariantChain& variant, const StageInstance& instance,
                    std::set<std::string>* printed) const {
    if (!printed->insert(instance.Id()).second) return;
    const InstanceState& state = StateOf(instance);
    fmt::print("{}: {} ({}) is {}\n", name_, instance.Id(), fmt::join(instance.variants, " "),
               NameOf(state.state));
    if (state.reasons.empty()) fmt::print("  nothing that it is made from has changed\n");
    for (const std::string& reason : state.reasons) fmt::print("  {}\n", reason);
    for (const std::string& change : ChangesSinceLastRun(plan_, variant, instance, folders_)) {
      fmt::print("  since the last complete run of {}: {}\n", variant.name, change);
    }
    for (const auto& [argument, source] : instance.inputs) {
      const StageInstance& input = plan_.Instance(source.instance);
      if (StateOf(input).state != StageState::kDone) PrintReasons(variant, input, printed);
    }
  }

  std::string name_;
  PlanFolders folders_;
  Plan plan_;
  std::map<std::string, InstanceState> states_;
};

}  // namespace

void RunStatus(const StatusOptions& options, const StageFiles& files, int /*threads*/) {
  const std::vector<std::string> stages = PipelineStages();
  if (!options.explain.empty() && std::ranges::find(stages, options.explain) == stages.end()) {
    throw SettingsError(fmt::format("setting 'explain' is '{}'; expected one of {}",
                                    options.explain, fmt::join(stages, ", ")));
  }
  const fs::path& results = files.at("results");
  const std::vector<std::string> datasets =
      options.name.empty() ? PlannedDatasets(results) : std::vector{options.name};
  if (datasets.empty()) {
    fmt::print("nothing ran yet: there is no {}\n", (results / "<dataset>/plan.mk").string());
  }
  std::map<std::string, StagesUnderWay> under_way;
  if (files.contains("under_way")) under_way = ReadStagesUnderWay(files.at("under_way"));
  std::optional<SettingsError> failure;  // the last one, once all others have been shown
  for (const std::string& name : datasets) {
    try {
      const Status status(name, options, files, under_way[name]);
      if (options.explain.empty()) {
        status.PrintTable();
      } else {
        status.PrintReasons(options.explain);
      }
    } catch (const Error& error) {
      failure.emplace(fmt::format("{}: {}", name, error.what()));
    }
  }
  if (failure) throw *failure;
}

}  // namespace soslam
