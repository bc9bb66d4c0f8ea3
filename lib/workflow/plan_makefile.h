// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "workflow/plan.h"

namespace soslam {

// Folders of a plan; relative paths are relative to where make runs.
struct PlanFolders {
  std::filesystem::path dataset;
  std::filesystem::path pipelines;
  std::filesystem::path results;  // results of this dataset: <results>/<name>
};

// Text of the makefile that executes a plan: one goal per variant, "all" first, and one rule per
// stage instance. It needs GNU make >= 4.3; $(BIN) is the folder of the executables, $(LAUNCH) the
// command that starts them ("srun -n1"; may be empty). For clusters there is a goal per work unit,
// listed in $(units), and `before-<unit>`, which is up to date when everything that the unit needs
// from the trunk is.
std::string PlanMakefile(const Plan& plan, const std::string& dataset, const PlanFolders& folders);

// Reads the folders named in a makefile by PlanMakefile. Throws InputError when there is no such
// file.
PlanFolders ReadPlanFolders(const std::filesystem::path& makefile);

}  // namespace soslam
