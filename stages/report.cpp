// SPDX-License-Identifier: BSD-3-Clause
#include "stage/command_line.h"
#include "stage/run_report.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ReportOptions>(
      argc, argv,
      {.name = "soslam-report",
       .purpose = "Puts the metrics of all datasets and variants in a results folder into tables.",
       .files = {{"results", "results folder, with <dataset>/<variant>/metrics.json"},
                 {"output", "tables.md to write; the tables are printed as well"}},
       .example = "soslam-report --results results --output results/tables.md"},
      &soslam::RunReport);
}
