// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::SynthesiseOptions>(
      argc, argv,
      {.name = "soslam-synthesise",
       .purpose = "Renders a scene description into a dataset folder with exact ground truth.",
       .inputs = {{"scene", "scene description, JSON"}},
       .outputs = {{"output", "dataset folder to write", true, false, true}},
       .example = "soslam-synthesise --scene scene.json --output data/my_scene"},
      &soslam::RunSynthesise);
}
