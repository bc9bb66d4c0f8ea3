// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "stage/plan.h"

namespace soslam {

// Where the files of a plan lie; relative paths are relative to where make runs.
struct PlanFolders {
  std::filesystem::path dataset;
  std::filesystem::path pipelines;
  std::filesystem::path results;  // of this dataset: <results>/<name>
};

// The text of the makefile that carries a plan out: one goal per variant, "all" first, and one rule
// per stage instance. It is for GNU make >= 4.3; $(BIN) is the folder of the executables, $(LAUNCH)
// what starts them ("srun -n1"; empty: nothing). For clusters there is a goal per work unit, as
// $(units) lists them, and `before-<unit>`, which is up to date when all that it needs from the
// trunk is.
std::string PlanMakefile(const Plan& plan, const std::string& dataset, const PlanFolders& folders);

// The folders that a makefile by PlanMakefile names. Throws InputError when there is no such file.
PlanFolders ReadPlanFolders(const std::filesystem::path& makefile);

}  // namespace soslam
