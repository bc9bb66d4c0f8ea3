// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/run_file.h"
#include "fuzz/fuzz_target.h"
#include "workflow/verify.h"

namespace soslam {
namespace {

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

}  // namespace
}  // namespace soslam
