// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/ground/options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::GroundOptions>(
      argc, argv,
      {.name = "soslam-ground",
       .purpose = "Finds up, scale and horizontal planes of a world that has neither up nor scale, "
                  "from sparse points, boxes and the heights of their labels.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"points", "points.h5 in the world of its poses"},
                  {"table", "semantic table with the height of each label"},
                  {"dataset",
                   "dataset folder with the images, where verticals are looked for, and turns.json "
                   "of soslam-detect, if there is one",
                   false},
                  {"matches", "matches.h5 of soslam-match; read if shared_points is true", false},
                  {"edits", "edits.json, as soslam-associate reads it: sizes in it tell the scale",
                   false}},
       .outputs = {{"output", "sequence.json to write: z up, in metres, with the planes of points"},
                   {"world", "world.json to write: what was found, how sure it is, and why"}},
       .example = "soslam-ground --ground estimated --sequence sequence.json --points points.h5 "
                  "--table pipelines/priors/semantic_table.json --dataset data/desk --output "
                  "ground.json --world world.json"},
      &soslam::RunGround);
}
