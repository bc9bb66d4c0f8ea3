// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

// A report always contains all datasets and variants, so that reports of different runs can be
// compared.
struct ReportOptions {
  std::string compare =
      "InitP InitS, InitPT InitSTE, InitS InitST InitSTE, OursP OursS, OursPT OursSTE, "
      "OursS OursST OursSTE OursSTEP";
  std::string maps = "OursS OursSTE OursS-raw OursSTE-raw OursS-raw-planes OursSTE-raw-planes";

  void Describe(OptionVisitor& visit) {
    visit.Group("Tables");
    visit.Text("compare", &compare,
               "paired differences: lists of variants, divided by commas; in each list, every "
               "variant is compared with those before it");
    visit.Text("maps", &maps,
               "variants whose maps are compared with all true objects in tables over all "
               "datasets: what is right, what is missed or false and why, what limits the rest");
  }
};

// Collects <dataset>/<variant>/metrics.json and the timing.json of the stages from folder "results"
// into tables: those of the paper, beside the values in file "published" if there is one; paired
// differences between variants; maps over all datasets; and all metrics of each dataset. Folder
// "datasets" has the settings of the datasets, which say what tables are to say of them. Prints the
// tables and writes them to file "output" as Markdown, and each to the folder "tables" beside it as
// CSV and LaTeX; renews the tables in file "page" if there is one. Throws NothingUsableError when
// there are no metrics at all, InputError for a file that is not valid, SettingsError for invalid
// comparisons.
void RunReport(const ReportOptions& options, const StageFiles& files, int threads);

// soslam-pages: writes <results>/<dataset>/report.html for each dataset with results to show, and
// <results>/report.html with all of them, each of at most kMaxPageBytes. Files: "results". Images
// are read from the datasets if these still exist. Results that are unreadable or planned but
// incomplete are listed on the pages and on stderr. Throws NothingUsableError when there is nothing
// to show.
void RunPages(const NoOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
