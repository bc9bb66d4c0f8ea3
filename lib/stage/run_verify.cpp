// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_verify.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "base/table.h"
#include "cli/command_line.h"
#include "workflow/verify.h"

namespace soslam {
namespace {

void Print(const DatasetRuns& dataset, const Verification& verification) {
  for (const Discrepancy& discrepancy : verification.discrepancies) {
    fmt::print("{} ({})\n", discrepancy.text, fmt::join(discrepancy.variants, ", "));
  }
  for (const std::string& run : dataset.unused) {
    fmt::print("{}: no variant uses it any more; not compared\n", (dataset.results / run).string());
  }
}

std::vector<Cell> Row(const DatasetRuns& dataset, const Verification& verification) {
  std::set<std::string> affected;
  for (const Discrepancy& discrepancy : verification.discrepancies) {
    affected.insert(discrepancy.variants.begin(), discrepancy.variants.end());
  }
  const std::string names =
      affected.empty() ? kNoValue : fmt::format("{}", fmt::join(affected, " "));
  return {dataset.name,
          names,
          fmt::format("{}", dataset.runs.size() + dataset.exports.size()),
          fmt::format("{}", dataset.unused.size()),
          fmt::format("{}", verification.files),
          fmt::format("{}", verification.discrepancies.size())};
}

}  // namespace

std::vector<DatasetRuns> FindRuns(const StageFiles& files) {
  const auto data_root = files.find("data_root");
  return FindRuns(files.at("results"),
                  data_root == files.end() ? std::filesystem::path() : data_root->second);
}

int RunVerify(const VerifyOptions& /*options*/, const StageFiles& files, int /*threads*/) {
  Table table;
  table.title = "Results and their records";
  table.header = {"dataset", "affected variants", "runs", "unused", "files", "findings"};
  table.left_columns = 2;
  bool has_findings = false;
  for (const DatasetRuns& dataset : FindRuns(files)) {
    const Verification verification = Verify(dataset);
    Print(dataset, verification);
    table.rows.push_back(Row(dataset, verification));
    has_findings = has_findings || !verification.discrepancies.empty();
  }
  fmt::print("{}", ToMarkdown(table));
  return has_findings ? kFindings : static_cast<int>(ExitCode::kDone);
}

}  // namespace soslam
