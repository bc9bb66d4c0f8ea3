// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_doctor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "artefact/findings_json.h"
#include "artefact/json_file.h"
#include "artefact/run_file.h"
#include "base/file_kind.h"
#include "base/one_line.h"
#include "cli/command_line.h"
#include "stage/run_plan.h"
#include "workflow/plan.h"
#include "workflow/plan_makefile.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// A finding of a stage's run and the variants that it concerns.
struct Diagnosis {
  Finding finding;
  std::string stage;
  std::set<std::string> variants;
};

std::vector<Finding> FindingsInFile(const fs::path& path) {
  try {
    return FindingsFromJson(ParseJsonFile(path));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: findings: {}", path.string(), error.what()));
  }
}

// Finding for a failed run; its message is complete, so cause and remedy stay empty.
Finding FailureOf(const RunRecord& run) {
  Finding failure;
  failure.check = "failed";
  failure.severity = Severity::kError;
  failure.found = run.error;
  return failure;
}

// Findings in the artefacts of a run, or its failure; none where it has not run.
std::vector<Finding> FindingsOfRun(const StageInstance& instance, const fs::path& results) {
  const fs::path record = results / InstancePath(instance.Id(), "run.json");
  if (!Exists(record)) return {};
  if (const RunRecord run = ReadRun(record); run.exit_code != 0) return {FailureOf(run)};
  std::vector<Finding> findings;
  for (const StageOutput& output : OutputsOfStage(instance.stage)) {
    const fs::path artefact = results / InstancePath(instance.Id(), output.file);
    if (artefact.extension() != ".json" || !Exists(artefact)) continue;
    std::ranges::move(FindingsInFile(artefact), std::back_inserter(findings));
  }
  return WorstFirst(std::move(findings));
}

// All diagnoses, worst first. A finding that later stages pass on is attributed to the first one.
std::vector<Diagnosis> DiagnosesOf(const Plan& plan, const fs::path& results) {
  std::vector<Diagnosis> diagnoses;
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

void Print(const Diagnosis& diagnosis) {
  const Finding& finding = diagnosis.finding;
  fmt::print("{}: {} ({}): {}\n", kSeverityNames[static_cast<size_t>(finding.severity)],
             diagnosis.stage, fmt::join(diagnosis.variants, " "), OneLine(finding.found));
  if (finding.expected.empty()) return;
  fmt::print("  expected      {}\n  likely cause  {}\n  remedy        {}\n",
             OneLine(finding.expected), OneLine(finding.cause), OneLine(finding.remedy));
}

}  // namespace

int RunDoctor(const DoctorOptions& options, const StageFiles& files, int /*threads*/) {
  const fs::path results = files.at("results") / options.name;
  const fs::path pipelines = ReadPlanFolders(results / "plan.mk").pipelines;
  const Plan plan = MakePlan(pipelines, options.name, PlannedVariants(pipelines, results));
  const std::vector<Diagnosis> diagnoses = DiagnosesOf(plan, results);
  for (const Diagnosis& diagnosis : diagnoses) Print(diagnosis);
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
