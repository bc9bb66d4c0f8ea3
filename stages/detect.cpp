// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/image/detector_options.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::DetectorOptions>(
      argc, argv,
      {.name = "soslam-detect",
       .purpose = "Runs a detector network on every image of a dataset.",
       .inputs = {{"dataset", "dataset folder with rgb.txt and the images"},
                  {"network", "ONNX file of a network: YOLO, DETR or PaddleDetection"},
                  {"labels",
                   "names of its classes, one a line; those in the network's file, or COCO's 80, "
                   "when absent",
                   false}},
       .outputs = {{"output", "detections.csv to write, without object ids"},
                   {"turns",
                    "turns.json to write: what is found in ten images as they are and turned by "
                    "quarters. The detections are then those in images turned upright, if they "
                    "are not; boxes refer to the images as they are",
                    false}},
       .example = "soslam-detect --dataset data/room_a --network yolov5s.onnx --output "
                  "detections.csv"},
      &soslam::RunDetect);
}
