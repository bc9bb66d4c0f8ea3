// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

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
