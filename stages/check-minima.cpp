// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-check-minima",
       .purpose =
           "Solves each object of a map alone from other yaws and sizes, with the inputs and "
           "settings in the record of its run (run.json), and says which ends lower than the map.",
       .inputs = {{"map", "map.json of soslam-optimise, with run.json beside it"}},
       .outputs = {},
       .example = "soslam-check-minima --map results/room_a/OursS/map.json",
       .findings = "an object has a lower minimum"},
      &soslam::RunCheckMinima);
}
