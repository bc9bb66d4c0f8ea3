// SPDX-License-Identifier: BSD-3-Clause
#include "report/variant_state.h"

#include <algorithm>

#include "base/file_kind.h"
#include "report/run_folder.h"

namespace soslam {

std::string WhyUnfinished(const VariantResult& variant) {
  for (const StageRun& run : variant.stages) {
    const std::string failure = FailureIn(run.folder);
    if (!failure.empty()) return "failed: " + run.stage + ": " + failure;
    if (!Exists(run.folder / "done")) return "incomplete: " + run.stage + " has not run";
  }
  const bool is_older =
      !std::ranges::equal(variant.stages, variant.shown_runs, {},
                          [](const StageRun& run) { return run.folder.filename().string(); });
  return is_older ? "incomplete: its files are those of an earlier plan" : "";
}

bool ShowsStage(const VariantResult& variant, const std::string& stage, const std::string& file) {
  if (variant.shown_runs.empty()) return Exists(variant.folder / file);
  return std::ranges::any_of(variant.shown_runs,
                             [&](const std::string& run) { return StageOf(run) == stage; });
}

}  // namespace soslam
