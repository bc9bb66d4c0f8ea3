// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/workflow/pipeline_stages.h"
#include "soslam/workflow/plan.h"

namespace soslam {
namespace {

using Ids = std::vector<std::string>;

template <typename Iterator>
void AppendNew(Iterator begin, Iterator end, Ids* ids) {
  std::copy_if(begin, end, std::back_inserter(*ids),
               [&](const std::string& id) { return std::ranges::find(*ids, id) == ids->end(); });
}

}  // namespace

std::vector<WorkUnit> SplitPlan(const Plan& plan) {
  const auto takes_long = [&](const std::string& id) {
    const std::string& stage = plan.Instance(id).stage;
    return stage == "refine" || stage == "optimise";
  };
  WorkUnit trunk = {.name = kTrunk};
  std::vector<WorkUnit> branches;
  for (const VariantChain& variant : plan.variants) {
    const auto begin = variant.instances.begin();
    const auto end = variant.instances.end();
    const auto fork = std::find_if(begin, end, takes_long);
    AppendNew(begin, fork, &trunk.instances);
    if (fork == end) {
      trunk.variants.push_back(variant.name);
      continue;
    }
    auto branch = std::ranges::find(branches, *fork, &WorkUnit::name);
    if (branch == branches.end()) branch = branches.insert(branch, {.name = *fork});
    AppendNew(fork, end, &branch->instances);
    AppendNew(begin, fork, &branch->needs);
    branch->variants.push_back(variant.name);
  }
  branches.insert(branches.begin(), std::move(trunk));
  return branches;
}

namespace {

namespace fs = std::filesystem;

// Make compares modification times, and unchanged artefacts keep theirs. Therefore a stage writes a
// stamp, `done`, with the time at which it began; artefacts depend on it with an empty recipe,
// after which make reads their times again (also in a dry run, because of its "+"). Stages that
// read them depend on both: when only stamps are newer there is nothing to do. A dry run cannot
// know which artefacts will change and lists every stage that may have to run.
constexpr const char* kPreamble =
    R"make(# Written by soslam-plan; changes here are lost.
results := {results}
dataset := {dataset_folder}
pipelines := {pipelines}
BIN ?= build/bin
THREADS ?= 0
QUIET ?=
OUTSIDE_PATHS ?=
LAUNCH ?=
.DELETE_ON_ERROR:
.SUFFIXES:
.PHONY: all imports {variants} FORCE
all: {variants}
imports: {imports}
FORCE:

dry_run := $(findstring n,$(firstword -$(MAKEFLAGS)))$(findstring q,$(firstword -$(MAKEFLAGS)))

# $(call missing,FILES): forces a rule when one of the files it made is gone.
missing = $(if $(filter-out $(wildcard $(1)),$(1)),FORCE)

# $(call stage,TITLE,COMMAND): runs a stage, through LAUNCH, unless nothing but stamps is newer than
# its own. When it fails, `failed` beside the stamp says how; a stage that crashes, or that LAUNCH
# did not start, cannot write that itself.
define run-stage
@echo '[{dataset}] $(1)'
@rm -f $(@D)/failed
@touch $@.begun
@$(LAUNCH) $(BIN)/$(2) --settings $(@D)/settings.json --threads $(THREADS) $(QUIET) $(OUTSIDE_PATHS) \
  --failure_record $(@D)/failed || {{ code=$$?; test -s $(@D)/failed || \
  echo "exit code $$code$(if $(LAUNCH), of LAUNCH or of a stage that was killed)" > $(@D)/failed; \
  exit $$code; }}
@mv $@.begun $@
endef
stage = $(if $(dry_run)$(filter-out %/done,$?),$(run-stage),@touch $@)
)make";

std::string Shared(const std::string& id, const std::string& file) {
  return "$(results)/" + InstancePath(id, file);
}

std::vector<std::string> Stamps(const std::vector<std::string>& ids) {
  std::vector<std::string> stamps;
  for (const std::string& id : ids) stamps.push_back(Shared(id, "done"));
  return stamps;
}

// Rules of a variant's folder, which contains links that are replaced together once its last
// stage is done; .linked is the stages.txt that they belong to.
std::string VariantRules(const Plan& plan, const VariantChain& variant) {
  const std::string folder = "$(results)/" + variant.name;
  std::vector<std::string> links, targets;
  // Maker of the version that later stages read, keyed by file name.
  std::map<std::string, std::string> last_maker;
  for (const std::string& id : variant.instances) {
    for (const StageOutput& output : OutputsOfStage(plan.Instance(id).stage)) {
      last_maker[output.file] = id;
    }
  }
  for (const auto& [file, id] : last_maker) {
    links.push_back(folder + "/" + file);
    targets.push_back("../shared/" + id + "/" + file);
  }
  return fmt::format(
      "\n{variant}: {folder}/.linked\n"
      "{folder}/.linked: {folder}/stages.txt {stamps} $(call missing,{links})\n"
      "\t@find {folder} -maxdepth 1 -type l -delete\n"
      "\t@ln -s {targets} {folder}/\n"
      "\t@cp $< $@\n",
      fmt::arg("variant", variant.name), fmt::arg("folder", folder),
      fmt::arg("stamps", fmt::join(Stamps(variant.instances), " ")),
      fmt::arg("links", fmt::join(links, " ")), fmt::arg("targets", fmt::join(targets, " ")));
}

std::string InstanceRules(const StageInstance& instance) {
  std::vector<std::string> prerequisites, outputs;
  const PlanFolders folders = {"$(dataset)", "$(pipelines)", "$(results)", "$(BIN)"};
  for (const auto& file : ListPrerequisites(instance, folders)) {
    prerequisites.push_back(file.string());
  }
  std::string command = "soslam-" + instance.stage;
  for (const auto& [argument, path] : FindStage(instance.stage)->other_inputs) {
    command +=
        fmt::format(" --{} {}", argument, fmt::format(fmt::runtime(path), instance.semantic_table));
  }
  if (instance.reads_edits) command += fmt::format(" --edits $(results)/{}", kEditsFile);
  std::set<std::string> stamps;
  for (const auto& [argument, source] : instance.inputs) {
    stamps.insert(Shared(source.instance, "done"));
    command += fmt::format(" --{} {}", argument, Shared(source.instance, source.file));
  }
  prerequisites.insert(prerequisites.end(), stamps.begin(), stamps.end());
  for (const StageOutput& output : OutputsOfStage(instance.stage)) {
    outputs.push_back(Shared(instance.Id(), output.file));
    command += fmt::format(" --{} {}", output.argument, outputs.back());
  }
  const std::string done = Shared(instance.Id(), "done");
  return fmt::format(
      "\n{done}: {prerequisites} $(call missing,{outputs})\n"
      "\t$(call stage,{id} ({variants}),{command})\n"
      "{outputs}: {done} ; +\n",
      fmt::arg("done", done), fmt::arg("outputs", fmt::join(outputs, " ")),
      fmt::arg("id", instance.Id()), fmt::arg("prerequisites", fmt::join(prerequisites, " ")),
      fmt::arg("variants", fmt::join(instance.variants, " ")), fmt::arg("command", command));
}

// Goals for the jobs of a cluster, for what each needs from the trunk, and lists of their
// instances.
std::string UnitRules(const Plan& plan) {
  const std::vector<WorkUnit> units = SplitPlan(plan);
  std::vector<std::string> names;
  for (const WorkUnit& unit : units) names.push_back(unit.name);
  std::string text =
      fmt::format("\nunits := {}\n.PHONY: $(units) $(units:%=before-%)\n", fmt::join(names, " "));
  for (const WorkUnit& unit : units) {
    text += fmt::format(
        "\nunit-{name} := {instances}\n"
        "{name}: {stamps} {variants}\n"
        "before-{name}: {needs}\n",
        fmt::arg("name", unit.name), fmt::arg("instances", fmt::join(unit.instances, " ")),
        fmt::arg("stamps", fmt::join(Stamps(unit.instances), " ")),
        fmt::arg("variants", fmt::join(unit.variants, " ")),
        fmt::arg("needs", fmt::join(Stamps(unit.needs), " ")));
  }
  return text;
}

}  // namespace

std::string PlanMakefile(const Plan& plan, const std::string& dataset, const PlanFolders& folders) {
  Ids names, imports;
  for (const VariantChain& variant : plan.variants) names.push_back(variant.name);
  for (const StageInstance& instance : plan.instances) {
    if (instance.stage == "import") imports.push_back(instance.Id());
  }
  std::string text =
      fmt::format(kPreamble, fmt::arg("pipelines", folders.pipelines.string()),
                  fmt::arg("variants", fmt::join(names, " ")), fmt::arg("dataset", dataset),
                  fmt::arg("imports", fmt::join(Stamps(imports), " ")),
                  fmt::arg("results", folders.results.string()),
                  fmt::arg("dataset_folder", folders.dataset.string()));
  for (const VariantChain& variant : plan.variants) text += VariantRules(plan, variant);
  for (const StageInstance& instance : plan.instances) text += InstanceRules(instance);
  return text + UnitRules(plan);
}

PlanFolders ReadPlanFolders(const fs::path& makefile) {
  std::ifstream stream(makefile);
  if (!stream) throw InputError(makefile.string() + ": cannot be read; nothing was planned yet");
  std::map<std::string, fs::path> values;
  for (std::string line; std::getline(stream, line);) {
    const size_t assigns = line.find(" := ");
    if (assigns != std::string::npos) values[line.substr(0, assigns)] = line.substr(assigns + 4);
  }
  const fs::path& pipelines = values["pipelines"];
  if (!IsFolder(pipelines)) {
    throw InputError(fmt::format(
        "{}: the folder of its settings, '{}', is not there, seen from {}; expected to be started "
        "in the folder in which make made the results",
        makefile.string(), pipelines.string(), fs::current_path().string()));
  }
  return {values["dataset"], pipelines, values["results"]};
}

}  // namespace soslam
