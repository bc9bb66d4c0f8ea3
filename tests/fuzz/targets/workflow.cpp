// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "soslam/artefact/run_file.h"
#include "soslam/report/results_tree.h"
#include "soslam/report/tables.h"
#include "soslam/workflow/pipeline_settings.h"
#include "soslam/workflow/plan.h"
#include "soslam/workflow/verify.h"

namespace soslam {
namespace {

const FuzzTarget kPipelines("pipelines", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  std::vector<std::string> variants;
  if (!IsAccepted(folder, [&] { variants = VariantNames(folder); })) return;
  for (const std::string& variant : variants) {
    IsAccepted(folder, [&] { ReadVariant(folder, "room", variant); });
  }
});

const FuzzTarget kRunRecord("run_record", [](const HostileInput& input) {
  const auto file = input.AsFile("run.json");
  RunRecord record;
  if (!IsAccepted(file, [&] { record = ReadRun(file); })) return;
  WriteRun(input.Output("run.json"), record);
  ReadRun(input.Output("run.json"));
});

// A results folder, as soslam-verify reads it.
const FuzzTarget kProvenance("provenance", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  IsAccepted(folder, [&] {
    for (const DatasetRuns& dataset : FindRuns(folder, {})) Verify(dataset);
  });
});

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
  ReadBy(input.AsFile("published.json"), ReadPublished);
});

}  // namespace
}  // namespace soslam
