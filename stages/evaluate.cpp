// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::EvaluateOptions>(
      argc, argv,
      {.name = "soslam-evaluate",
       .purpose = "Compares landmarks with the ground truth of the dataset.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"landmarks", "initial.json, refined.json or map.json"}},
       .outputs = {{"output", "metrics.json to write"}},
       .example =
           "soslam-evaluate --sequence sequence.json --landmarks map.json --output metrics.json"},
      &soslam::RunEvaluate);
}
