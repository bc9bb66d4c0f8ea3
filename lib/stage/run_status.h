// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

struct StatusOptions {
  std::string name;
  std::string variants;
  std::string explain;

  void Describe(OptionVisitor& visit) {
    visit.Group("Status");
    visit.Text("name", &name, "name of the dataset in results; empty: all that were planned");
    visit.Text("variants", &variants, "names of variants, separated by spaces; empty: all");
    visit.Text("explain", &explain,
               "a stage: says why it would run again; empty: a table of all stages");
  }
};

// soslam-status: plans the datasets in folder "results" again, and prints which stages of which
// variants are done, stale, failed or missing, or why one stage would run. "executables" is the
// folder of the stages' programs; "under_way", if given, lists queued and running stages, see
// ReadStagesUnderWay. Throws InputError when that dataset was never planned; SettingsError for an
// unknown variant or stage, and as RunPlan.
void RunStatus(const StatusOptions& options, const StageFiles& files, int threads);

struct DoctorOptions {
  std::string name;

  void Describe(OptionVisitor& visit) {
    visit.Group("Doctor");
    visit.Text("name", &name, "name of the dataset in results");
  }
};

// Prints the findings of all completed stages of a dataset in folder "results", and the errors of
// failed ones: worst first, each with its likely cause and remedy. The exit code is kFindings when
// there is an error. Throws InputError when nothing was planned for the dataset; SettingsError as
// MakePlan.
int RunDoctor(const DoctorOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
