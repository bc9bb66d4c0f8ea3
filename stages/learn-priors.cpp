// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/priors/learn_priors.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::LearnPriorsOptions>(
      argc, argv,
      {.name = "soslam-learn-priors",
       .purpose = "Makes a semantic table from ground truth and furniture catalogues.",
       .inputs = {{"base", "semantic table to start from", false},
                  {"furniture", "CSV with columns name,category,depth_m,width_m,height_m", false},
                  {"furniture_labels", "JSON: which of its names count as which label", false},
                  {"sequence", "sequence.json with ground truth to learn from", false, true},
                  {"held_out", "sequence.json to judge the table by, not to learn from", false,
                   true}},
       .outputs = {{"output", "semantic table to write"}},
       .example = "soslam-learn-priors --base pipelines/priors/semantic_table.json "
                  "--sequence sequence.json --output table.json"},
      &soslam::RunLearnPriors);
}
