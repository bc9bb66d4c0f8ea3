// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/options.h"
#include "stage/stage_files.h"

namespace soslam {

struct PlanOptions {
  std::string name;
  std::string variants;

  void Describe(OptionVisitor& visit) {
    visit.Group("Plan");
    visit.Text("name", &name, "name of the dataset in results and settings; empty: its folder's");
    visit.Text("variants", &variants,
               "names of variants, separated by spaces; planned: those that were planned before; "
               "empty: all");
  }
};

// The words of a list of names, each once.
std::vector<std::string> SplitAtSpaces(const std::string& text);

// All variants that folder `pipelines` defines; where the dataset called `name` in folder `dataset`
// has no images, those that look at none. Errors as RunPlan.
std::vector<std::string> PossibleVariants(const std::filesystem::path& pipelines,
                                          const std::string& name,
                                          const std::filesystem::path& dataset);

// Those of the variants in folder `pipelines` that have been planned in folder `results` of a
// dataset.
std::vector<std::string> PlannedVariants(const std::filesystem::path& pipelines,
                                         const std::filesystem::path& results);

// Resolves the variants that folder "pipelines" defines for the dataset in folder "dataset". Under
// <results>/<name> it writes, each only when its content changes: plan.mk, see PlanMakefile;
// shared/<stage>-<key>/settings.json; shared/dataset.txt and shared/images.txt, which list the
// dataset's files with size and time; and <variant>/stages.txt. Throws InputError when there is no
// such dataset; SettingsError as MakePlan, and for a path with characters that make cannot handle.
void RunPlan(const PlanOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
