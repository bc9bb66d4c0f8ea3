// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "report/dataset_tables.h"
#include "report/paired_differences.h"
#include "report/paper_tables.h"
#include "report/results_tree.h"
#include "report/timing_table.h"
#include "workflow/plan_makefile.h"

namespace soslam {
namespace {

// A results folder, as soslam-report reads it.
const FuzzTarget kResults("results", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  IsAccepted(folder, [&] {
    const std::vector<DatasetResult> datasets = ReadResults(folder);
    PaperTables(datasets, {});
    TimeTable(datasets, {});
    DifferencesTable(datasets, {}, kIou);
    for (const DatasetResult& dataset : datasets) DatasetTable(dataset);
  });
  IsAccepted(folder, [&] { ReadPlanFolders(folder / "plan.mk"); });
});

const FuzzTarget kPublished("published", [](const HostileInput& input) {
  const auto file = input.AsFile("published.json");
  IsAccepted(file, [&] { ReadPublished(file); });
});

}  // namespace
}  // namespace soslam
