// SPDX-License-Identifier: BSD-3-Clause
#include "report/variant_state.h"

#include <algorithm>
#include <fstream>

#include "base/file_kind.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::string FirstLine(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

}  // namespace

std::string WhyUnfinished(const VariantResult& variant) {
  for (const StageRun& run : variant.stages) {
    const std::string failure = FirstLine(run.folder / "failed");
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
  return std::ranges::any_of(variant.shown_runs, [&](const std::string& run) {
    return run.substr(0, run.rfind('-')) == stage;
  });
}

}  // namespace soslam
