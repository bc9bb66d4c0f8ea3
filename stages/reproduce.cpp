// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-reproduce",
       .purpose = "Runs once more what made the variants in a results folder, with the settings "
                  "that were recorded (run.json), and says which artefacts come out the same, byte "
                  "by byte. Writes into a folder beside the results and removes it at the end.",
       .inputs = {{"results", "results folder, with <dataset>/<variant>/stages.txt"},
                  {"executables", "folder with the programs of the stages"},
                  {"data_root", "folder of the datasets; without it they are where they were",
                   false}},
       .outputs = {},
       .example = "soslam-reproduce --results results --executables build/bin",
       .findings = "an artefact differs, or could not be made again"},
      &soslam::RunReproduce);
}
