// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/initialisation/options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::InitialiseOptions>(
      argc, argv,
      {.name = "soslam-initialise",
       .purpose = "Estimates landmarks from single observations, or from all boxes of an object.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"table", "semantic table with the size ratio of each label"},
                  {"edges", "edges.h5 of soslam-edges; needed when method = cuboid_proposals",
                   false},
                  {"appearance",
                   "appearance.h5 of soslam-appearance; needed when picture_yaw or picture_ratios "
                   "is true",
                   false},
                  {"points",
                   "points.h5 of soslam-track or soslam-reconstruct; needed when the setting "
                   "point_evidence is true, with method = yaw_sweep",
                   false}},
       .outputs = {{"output", "initial.json to write"}},
       .example = "soslam-initialise --sequence sequence.json --table "
                  "pipelines/priors/semantic_table.json --output initial.json"},
      &soslam::RunInitialise);
}
