// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ReportOptions>(
      argc, argv,
      {.name = "soslam-report",
       .purpose = "Puts the metrics and times of all datasets and variants in a results folder "
                  "into tables: those of the paper, paired differences between variants, and one "
                  "for each dataset.",
       .inputs = {{"results", "results folder, with <dataset>/<variant>/metrics.json"},
                  {"published", "values to show beside the measured ones", false},
                  {"datasets", "folder with <dataset>.json, whose \"about\" tables show", false}},
       .outputs =
           {{"output",
             "tables.md to write, which is printed as well; tables/*.csv and *.tex go beside it"},
            {"page", "page whose tables, between its markers, are renewed", false}},
       .example = "soslam-report --results results --published pipelines/published.json "
                  "--datasets pipelines/datasets --output results/tables.md"},
      &soslam::RunReport);
}
