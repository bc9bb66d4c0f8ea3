// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/planes/options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::PlanesOptions>(
      argc, argv,
      {.name = "soslam-planes",
       .purpose = "Estimates the planes that objects stand on or hang from, and which is on which, "
                  "from their boxes; or takes the ground from the height of the camera.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"table", "semantic table with the size ratio of each label"},
                  {"dataset", "dataset folder with the images, where verticals are looked for",
                   false}},
       .outputs = {{"output", "sequence.json to write, with the estimated planes"},
                   {"report", "planes.json to write: the planes, how sure they are, and why"}},
       .example = "soslam-planes --dataset data/room_a --sequence sequence.json --table "
                  "pipelines/priors/semantic_table.json --planes estimated --output "
                  "with_planes.json --report planes.json"},
      &soslam::RunPlanes);
}
