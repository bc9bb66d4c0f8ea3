// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::StatusOptions>(
      argc, argv,
      {.name = "soslam-status",
       .purpose = "Says which stages are done, stale, failed or missing, and why one would run.",
       .inputs = {{"results", "results folder, with <dataset>/plan.mk of soslam-plan"},
                  {"executables", "folder with the programs of the stages"},
                  {"under_way",
                   "what is queued or running now: lines <dataset> <stage run> queued|running, as "
                   "of pipelines/under-way",
                   false}},
       .outputs = {},
       .example = "soslam-status --results results --executables build/bin --explain refine"},
      &soslam::RunStatus);
}
