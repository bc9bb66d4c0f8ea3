// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-truth",
       .purpose = "Gives photos the ground truth of an annotated dataset of the same photos.",
       .inputs =
           {{"dataset", "dataset folder of soslam-frames, with rgb.txt and frames.json"},
            {"truth",
             "annotated dataset folder, with rgb.txt, groundtruth.txt (TUM) and objects.json, "
             "whose images have the names of the photos"}},
       .outputs = {{"output",
                    "folder for groundtruth.txt, with the photos' times, and objects.json", true,
                    false, true}},
       .example = "soslam-truth --dataset maps/room_a/frames --truth data/room_a --output truth"},
      &soslam::RunTruth);
}
