// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-verify",
       .purpose = "Compares the files of a results folder, and those that they were made from, "
                  "with the records of the runs (run.json): says what has changed since, is gone, "
                  "failed or has no record, and which variants that affects.",
       .inputs = {{"results", "results folder, with <dataset>/<variant>/stages.txt"},
                  {"data_root", "folder of the datasets; without it they are where they were",
                   false}},
       .outputs = {},
       .example = "soslam-verify --results results",
       .findings = "a file does not match its record"},
      &soslam::RunVerify);
}
