// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/image/feature_tracks.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::TrackOptions>(
      argc, argv,
      {.name = "soslam-track",
       .purpose = "Sparse points from features that are followed through the images, triangulated "
                  "from the poses that the sequence has.",
       .inputs = {{"dataset", "dataset folder with the images"},
                  {"sequence", "sequence.json of soslam-import"}},
       .outputs = {{"output", "points.h5 to write"}},
       .example = "soslam-track --dataset data/room_a --sequence sequence.json --output points.h5"},
      &soslam::RunTrack);
}
