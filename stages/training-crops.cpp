// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"
#include "soslam/training/training_crops.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::TrainingCropsOptions>(
      argc, argv,
      {.name = "soslam-training-crops",
       .purpose = "Renders furniture and writes what the inner layers of a detector say of it.",
       .inputs = {{"furniture", "folder with unpacked furniture libraries of Sweet Home 3D"},
                  {"groups", "JSON: which models are learned together"},
                  {"network", "ONNX file of the detector"}},
       .outputs = {{"output", "HDF5 file for training a head"}},
       .example = "soslam-training-crops --furniture furniture --groups "
                  "pipelines/training/groups.json --network yolox_nano.onnx --output crops.h5",
       .is_recorded = false},
      &soslam::RunTrainingCrops);
}
