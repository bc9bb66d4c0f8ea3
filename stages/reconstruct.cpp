// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/dataset/reconstruct_options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ReconstructOptions>(
      argc, argv,
      {.name = "soslam-reconstruct",
       .purpose = "Estimates poses, camera and sparse points from images, with COLMAP.",
       .inputs = {{"dataset",
                   "folder with rgb.txt, the images, and what is given of camera.json "
                   "and odometry.txt"},
                  {"model", "finished model of COLMAP, a folder; COLMAP does not run then", false}},
       .outputs = {{"output",
                    "folder for camera.json, odometry.txt, points.h5 and reconstruction.json; may "
                    "be the dataset",
                    true, false, true}},
       .example = "soslam-reconstruct --dataset data/room --output data/room"},
      &soslam::RunReconstruct);
}
