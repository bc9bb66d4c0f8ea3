// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::NoOptions>(
      argc, argv,
      {.name = "soslam-pages",
       .purpose =
           "Makes a page to look at for each dataset in a results folder, and one of them all.",
       .inputs = {},
       .outputs = {{"results",
                    "results folder; gets report.html, and one in each dataset's folder"}},
       .example = "soslam-pages --results results",
       .is_recorded = false},
      &soslam::RunPages);
}
