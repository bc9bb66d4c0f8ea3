// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/image/feature_matches.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::MatchOptions>(
      argc, argv,
      {.name = "soslam-match",
       .purpose = "Finds points that several images show, also images far apart, by the poses.",
       .inputs = {{"dataset", "dataset folder with the images"},
                  {"sequence", "sequence.json of soslam-import"}},
       .outputs = {{"output", "matches.h5 to write"}},
       .example =
           "soslam-match --dataset data/room_a --sequence sequence.json --output matches.h5"},
      &soslam::RunMatch);
}
