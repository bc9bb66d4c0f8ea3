// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/image/edge_maps.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::EdgesOptions>(
      argc, argv,
      {.name = "soslam-edges",
       .purpose = "Computes edges, distance transform, nearest edges and corners of every image.",
       .inputs = {{"dataset", "dataset folder with the images"},
                  {"sequence", "sequence.json of soslam-import"}},
       .outputs = {{"output", "edges.h5 to write"}},
       .example = "soslam-edges --dataset data/room_a --sequence sequence.json --output edges.h5"},
      &soslam::RunEdges);
}
