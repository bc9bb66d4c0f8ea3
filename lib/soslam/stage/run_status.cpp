// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/run_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/report/results_tree.h"
#include "soslam/stage/stages.h"
#include "soslam/workflow/pipeline_stages.h"
#include "soslam/workflow/plan.h"
#include "soslam/workflow/plan_state.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> PlannedDatasets(const fs::path& results) {
  std::vector<std::string> names = ListSubfolders(results);
  std::erase_if(names,
                [&](const std::string& name) { return !Exists(results / name / "plan.mk"); });
  return names;
}

// Plan and states of one dataset's runs.
class Status {
 public:
  Status(std::string name, const StatusOptions& options, const StageFiles& files,
         const StagesUnderWay& under_way)
      : name_(std::move(name)), folders_(ReadPlanFolders(files.at("results") / name_ / "plan.mk")) {
    folders_.results = files.at("results") / name_;
    folders_.executables = files.at("executables");
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
    plan_ = MakePlan(folders_.pipelines, name_, Variants(options),
                     Exists(folders_.results / kEditsFile));
    states_ = DetermineStates(plan_, folders_, under_way);
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
    std::vector<std::string> variants = SplitAtSpaces(options.variants);
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

namespace {

// A finding of a stage's run and the variants that it concerns; none for findings of the settings.
struct Diagnosis {
  Finding finding;
  std::string stage;
  std::set<std::string> variants;
};

// Findings in the artefacts of a run, or its failure; none where it has not run.
std::vector<Finding> FindingsOfRun(const StageInstance& instance, const fs::path& results) {
  const fs::path record = results / InstancePath(instance.Id(), "run.json");
  if (!Exists(record)) return {};
  // The message of a failure is complete: cause and remedy stay empty.
  const RunRecord run = ReadRun(record);
  if (run.exit_code != 0) return {{"failed", Severity::kError, run.error, "", "", ""}};
  std::vector<Finding> findings;
  for (const StageOutput& output : OutputsOfStage(instance.stage)) {
    const fs::path artefact = results / InstancePath(instance.Id(), output.file);
    if (artefact.extension() != ".json" || !Exists(artefact)) continue;
    const nlohmann::json document = ParseJsonFile(artefact);
    try {
      std::ranges::move(ReadFindings(document), std::back_inserter(findings));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: findings: {}", artefact.string(), error.what()));
    }
  }
  return WorstFirst(std::move(findings));
}

// All diagnoses, worst first. A finding that later stages pass on is attributed to the first one.
std::vector<Diagnosis> CollectDiagnoses(const Plan& plan, const fs::path& results) {
  std::vector<Diagnosis> diagnoses;
  for (const Finding& finding : plan.findings) diagnoses.push_back({finding, "settings", {}});
  for (const StageInstance& instance : plan.instances) {
    for (const Finding& finding : FindingsOfRun(instance, results)) {
      auto known = std::ranges::find(diagnoses, finding, &Diagnosis::finding);
      if (known == diagnoses.end()) {
        known = diagnoses.insert(known, {finding, instance.stage, {}});
      }
      known->variants.insert(instance.variants.begin(), instance.variants.end());
    }
  }
  std::ranges::stable_sort(diagnoses, std::ranges::greater(),
                           [](const Diagnosis& diagnosis) { return diagnosis.finding.severity; });
  return diagnoses;
}

}  // namespace

int RunDoctor(const DoctorOptions& options, const StageFiles& files, int /*threads*/) {
  if (options.name.empty()) {
    const std::vector<std::string> planned = PlannedDatasets(files.at("results"));
    throw SettingsError(fmt::format(
        "setting 'name' is ''; expected a dataset in {}: {}", files.at("results").string(),
        planned.empty() ? "none was planned there yet" : NamesInWords(planned, 10)));
  }
  const fs::path results = files.at("results") / options.name;
  const fs::path pipelines = ReadPlanFolders(results / "plan.mk").pipelines;
  const Plan plan = MakePlan(pipelines, options.name, PlannedVariants(pipelines, results),
                             Exists(results / kEditsFile));
  const std::vector<Diagnosis> diagnoses = CollectDiagnoses(plan, results);
  for (const Diagnosis& diagnosis : diagnoses) {
    const Finding& finding = diagnosis.finding;
    const std::string variants = fmt::format("{}", fmt::join(diagnosis.variants, " "));
    fmt::print("{}: {}{}: {}\n", kSeverityNames[static_cast<size_t>(finding.severity)],
               diagnosis.stage, variants.empty() ? "" : " (" + variants + ")",
               OneLine(finding.found));
    if (finding.expected.empty()) continue;
    fmt::print("  expected      {}\n  likely cause  {}\n  remedy        {}\n",
               OneLine(finding.expected), OneLine(finding.cause), OneLine(finding.remedy));
  }
  const auto has_run = [&](const StageInstance& instance) {
    return Exists(results / InstancePath(instance.Id(), "run.json"));
  };
  const auto errors = std::ranges::count_if(diagnoses, [](const Diagnosis& diagnosis) {
    return diagnosis.finding.severity == Severity::kError;
  });
  fmt::print("{}: {} error(s), {} warning(s) in {} of {} stage runs of {} variant(s)\n",
             options.name, errors, static_cast<std::ptrdiff_t>(diagnoses.size()) - errors,
             std::ranges::count_if(plan.instances, has_run), plan.instances.size(),
             plan.variants.size());
  return errors > 0 ? kFindings : static_cast<int>(ExitCode::kDone);
}

}  // namespace soslam
