// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::PlanOptions>(
      argc, argv,
      {.name = "soslam-plan",
       .purpose =
           "Works out which stages the variants of a dataset need and writes them as a makefile.",
       .inputs = {{"dataset", "dataset folder"},
                  {"pipelines", "folder with base.json, variants/ and datasets/"},
                  {"edits",
                   "edits.json with corrections of the association by hand, which is kept in the "
                   "results for later runs; see soslam-associate --help",
                   false}},
       .outputs = {{"results",
                    "results folder; writes <results>/<dataset>/plan.mk and what it needs"}},
       .example = "soslam-plan --dataset data/room_a --pipelines pipelines --results results",
       .is_recorded = false},
      &soslam::RunPlan);
}
