// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/image/frame_choice.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::FrameOptions>(
      argc, argv,
      {.name = "soslam-frames",
       .purpose = "Chooses sharp images with motion between them from photos or a video.",
       .inputs = {{"images", "folder of photos, or a video"},
                  {"detections",
                   "detections.csv for all of them, whose frames are numbered from 0 in the order "
                   "of names or of the video; those of chosen images are written",
                   false}},
       .outputs = {{"output",
                    "dataset folder to write: rgb/, rgb.txt, and frames.json, which says what was "
                    "left out, and why",
                    true, false, true}},
       .example = "soslam-frames --images \"holiday photos\" --output data/my_room"},
      &soslam::RunFrames);
}
