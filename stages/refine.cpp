// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::OrientationOptions>(
      argc, argv,
      {.name = "soslam-refine",
       .purpose = "Refines each landmark: its yaw by the symmetry of its texture, or all of it by "
                  "its orientation profile.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"table", "semantic table with the size ratio of each label"},
                  {"initial", "initial.json of soslam-initialise"},
                  {"edges", "edges.h5 of soslam-edges"},
                  {"appearance",
                   "appearance.h5 of soslam-appearance; needed when picture_yaw or picture_ratios "
                   "is true",
                   false},
                  {"points",
                   "points.h5 of soslam-track or soslam-reconstruct; needed when the setting "
                   "point_evidence is true, with method = profile",
                   false}},
       .outputs = {{"output", "refined.json to write"},
                   {"curves", "symmetry.h5 to write: the cost over yaw of every observation"}},
       .example =
           "soslam-refine --sequence sequence.json --table pipelines/priors/semantic_table.json "
           "--initial initial.json --edges edges.h5 --output refined.json --curves symmetry.h5"},
      &soslam::RunRefine);
}
