// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/options.h"
#include "cli/stage_files.h"

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

// Words of a list of names, without duplicates.
std::vector<std::string> SplitAtSpaces(const std::string& text);

// All variants defined in folder `pipelines`; if the dataset `name` in folder `dataset` has no
// images, only variants that do not use images. Errors as RunPlan.
std::vector<std::string> PossibleVariants(const std::filesystem::path& pipelines,
                                          const std::string& name,
                                          const std::filesystem::path& dataset);

// Variants of folder `pipelines` that have been planned in the results folder of a dataset.
std::vector<std::string> PlannedVariants(const std::filesystem::path& pipelines,
                                         const std::filesystem::path& results);

// soslam-plan: resolves the variants that folder "pipelines" defines for the dataset in folder
// "dataset". Writes under <results>/<name>, each only when its content changes: plan.mk, see
// PlanMakefile; shared/<stage>-<key>/settings.json; shared/dataset.txt and shared/images.txt, which
// list the dataset's files with size and time; and <variant>/stages.txt. Throws InputError when
// there is no such dataset; SettingsError as MakePlan, and for a path with characters that make
// cannot handle.
void RunPlan(const PlanOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
