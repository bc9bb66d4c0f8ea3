// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::DoctorOptions>(
      argc, argv,
      {.name = "soslam-doctor",
       .purpose = "Says what the stages of a dataset found that does not fit, worst first, each "
                  "with its likely cause and remedy.",
       .inputs = {{"results", "results folder, with <dataset>/plan.mk of soslam-plan"}},
       .outputs = {},
       .example = "soslam-doctor --results results --name room_a",
       .findings = "something cannot be right, or a stage failed"},
      &soslam::RunDoctor);
}
