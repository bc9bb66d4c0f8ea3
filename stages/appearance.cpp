// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-appearance",
       .purpose = "Says from which side each box shows its object, and in which proportions.",
       .inputs = {{"dataset", "dataset folder with the images"},
                  {"sequence", "sequence.json with support planes"},
                  {"network", "ONNX file of the detector network that the head belongs to"},
                  {"head", "head.h5, trained on the network's inner layers"}},
       .outputs = {{"output", "appearance.h5 to write"}},
       .example =
           "soslam-appearance --dataset data/room_a --sequence sequence.json --network "
           "yolox_nano.onnx --head pipelines/pictures/heads/yolox_nano.h5 --output appearance.h5"},
      &soslam::RunAppearance);
}
