// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "soslam/workflow/plan.h"

namespace soslam {

enum class StageState {
  kDone,     // up to date
  kStale,    // ran, but would run again
  kFailed,   // its last run failed
  kMissing,  // has not completed yet
  kQueued,   // one of the previous three, and a job for it is queued
  kRunning,  // runs now
};
inline constexpr std::array kStageStateNames = {"done",    "stale",  "failed",
                                                "missing", "queued", "running"};
constexpr const char* NameOf(StageState state) {
  return kStageStateNames.at(static_cast<size_t>(state));
}

// State of a stage instance, by the rules of the makefile.
struct InstanceState {
  StageState state = StageState::kDone;
  // Reasons why it would run, one line each; empty when it would not.
  std::vector<std::string> reasons;
};

// Instances that are kQueued or kRunning unless they are done, keyed by id.
using StagesUnderWay = std::map<std::string, StageState>;

// Reads a file with lines "<dataset> <id> queued|running"; the result is keyed by dataset. Running
// wins where there are several lines. Throws InputError for any other line.
std::map<std::string, StagesUnderWay> ReadStagesUnderWay(const std::filesystem::path& file);

// States of all instances of a plan, keyed by id. Nothing is written. The listings of the dataset
// (see RunPlan) are assumed to be correct.
std::map<std::string, InstanceState> DetermineStates(const Plan& plan, const PlanFolders& folders,
                                                     const StagesUnderWay& under_way = {});

// Differences of settings and inputs between a variant's instance and the last complete run of the
// variant, one line each: "yaw_step_deg: 2.0 -> 5.0". Empty when there is none, or the variant has
// never been complete.
std::vector<std::string> ChangesSinceLastRun(const Plan& plan, const VariantChain& variant,
                                             const StageInstance& instance,
                                             const PlanFolders& folders);

}  // namespace soslam
