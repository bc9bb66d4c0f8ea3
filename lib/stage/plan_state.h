// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "stage/plan.h"
#include "stage/plan_makefile.h"

namespace soslam {

enum class StageState {
  kDone,     // make has nothing to do for it
  kStale,    // ran, and would run again
  kFailed,   // its last run failed
  kMissing,  // has not run to the end yet
  kQueued,   // one of these three, and a job that will run it waits
  kRunning,  // runs now
};
const char* NameOf(StageState state);

// What a stage instance has come to, by the rules of the makefile.
struct InstanceState {
  StageState state = StageState::kDone;
  // Why it would run, one line each, in words; empty when it would not.
  std::vector<std::string> reasons;
};

// Instances that are kQueued or kRunning unless they are done, by id.
using StagesUnderWay = std::map<std::string, StageState>;

// By dataset, what a file with a line "<dataset> <id> queued|running" for each such instance says.
// Running wins where there are several lines. Throws InputError for another line.
std::map<std::string, StagesUnderWay> ReadStagesUnderWay(const std::filesystem::path& file);

// The states of all instances of a plan, by id. `executables` is the folder of the stages'
// programs. Nothing is written. What the listings of the dataset (see RunPlan) say is taken for
// true.
std::map<std::string, InstanceState> StatesOf(const Plan& plan, const PlanFolders& folders,
                                              const std::filesystem::path& executables,
                                              const StagesUnderWay& under_way = {});

// How the settings and inputs of a variant's instance differ from those of the last complete run of
// the variant, one line each: "yaw_step_deg: 2.0 -> 5.0". Empty when they do not differ, or the
// variant has not been complete yet.
std::vector<std::string> ChangesSinceLastRun(const Plan& plan, const VariantChain& variant,
                                             const StageInstance& instance,
                                             const PlanFolders& folders);

}  // namespace soslam
