// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/dataset/import_options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ImportOptions>(
      argc, argv,
      {.name = "soslam-import",
       .purpose = "Reads a dataset folder, checks it and keeps the usable detections.",
       .inputs = {{"dataset", "dataset folder, in the format that the settings name"}},
       .outputs = {{"output", "sequence.json to write"}},
       .example = "soslam-import --dataset data/room_a --output sequence.json"},
      &soslam::RunImport);
}
