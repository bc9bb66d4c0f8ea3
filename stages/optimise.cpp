// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/mapping/options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::OptimiseOptions>(
      argc, argv,
      {.name = "soslam-optimise",
       .purpose = "The back end: optimises all landmarks and camera poses together.",
       .inputs =
           {{"sequence", "sequence.json of soslam-import"},
            {"landmarks", "initial.json or refined.json to start from"},
            {"table", "semantic table with the size ratio of each label"},
            {"edges",
             "edges.h5 of soslam-edges; needed when the setting symmetry or edge_alignment is true",
             false},
            {"appearance",
             "appearance.h5 of soslam-appearance; needed when picture_yaw or picture_ratios is "
             "true",
             false},
            {"points",
             "points.h5 of soslam-track or soslam-reconstruct; needed when the setting "
             "point_evidence is true",
             false}},
       .outputs = {{"output", "map.json to write"}},
       .example = "soslam-optimise --sequence sequence.json --landmarks initial.json --table "
                  "pipelines/priors/semantic_table.json --output map.json"},
      &soslam::RunOptimise);
}
