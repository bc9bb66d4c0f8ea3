// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workflow/plan.h"

namespace soslam {

// Stage instances of a plan that form one job on a cluster.
struct WorkUnit {
  std::string name;                         // "trunk", or the id of the first instance of a branch
  std::vector<std::string> instances = {};  // ids, each after the instances that it reads from
  std::vector<std::string> variants = {};   // variants that are complete when this unit is
  std::vector<std::string> needs = {};      // ids of the trunk's instances that a branch reads from
};

inline constexpr const char* kTrunk = "trunk";

// Splits a plan into the trunk, which all others need, and its branches. A branch begins at a stage
// that can take long (refine, optimise) and continues to the end of all variants that share its
// beginning, so branches do not share instances and can run in parallel. Everything else is the
// trunk: stages that take less time than a job costs, and the edges, which many branches read.
std::vector<WorkUnit> WorkUnitsOf(const Plan& plan);

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
