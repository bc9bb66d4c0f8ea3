// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <set>

#include "soslam/base/error.h"
#include "soslam/base/table.h"
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"
#include "soslam/workflow/verify.h"

namespace soslam {
namespace {

// The runs in folder "results", of datasets in folder "data_root".
std::vector<DatasetRuns> FindRecordedRuns(const StageFiles& files) {
  const auto data_root = files.find("data_root");
  return FindRuns(files.at("results"),
                  data_root == files.end() ? std::filesystem::path() : data_root->second);
}

}  // namespace

int RunVerify(const NoOptions& /*options*/, const StageFiles& files, int /*threads*/) {
  Table table;
  table.title = "Results and their records";
  table.header = {"dataset", "affected variants", "runs", "unused", "files", "findings"};
  table.left_columns = 2;
  bool has_findings = false;
  for (const DatasetRuns& dataset : FindRecordedRuns(files)) {
    const Verification verification = Verify(dataset);
    std::set<std::string> affected;
    for (const Discrepancy& discrepancy : verification.discrepancies) {
      fmt::print("{} ({})\n", discrepancy.text, fmt::join(discrepancy.variants, ", "));
      affected.insert(discrepancy.variants.begin(), discrepancy.variants.end());
    }
    for (const std::string& run : dataset.unused) {
      fmt::print("{}: no variant uses it any more; not compared\n",
                 (dataset.results / run).string());
    }
    table.rows.push_back({dataset.name,
                          affected.empty() ? kNoValue : fmt::format("{}", fmt::join(affected, " ")),
                          std::to_string(dataset.runs.size() + dataset.exports.size()),
                          std::to_string(dataset.unused.size()), std::to_string(verification.files),
                          std::to_string(verification.discrepancies.size())});
    has_findings = has_findings || !verification.discrepancies.empty();
  }
  fmt::print("{}", ToMarkdown(table));
  return has_findings ? kFindings : static_cast<int>(ExitCode::kDone);
}

namespace {

namespace fs = std::filesystem;

constexpr std::array kOutcomeNames = {"same", "differs", "not rerun"};

// Temporary folder beside another one, removed with its content at the end.
class FolderBeside {
 public:
  explicit FolderBeside(const fs::path& folder) {
    std::string name = fs::canonical(folder).string() + ".again-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      throw SettingsError(name + ": cannot be made; expected a folder that can be written to");
    }
    path_ = name;
  }
  ~FolderBeside() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  FolderBeside(const FolderBeside&) = delete;
  FolderBeside& operator=(const FolderBeside&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

int RunReproduce(const NoOptions& /*options*/, const StageFiles& files, int threads) {
  Table table;
  table.title = "Results made again";
  table.header = {"dataset", "runs", "artefacts the same", "that differ", "runs not rerun"};
  std::set<std::string> software_changes;
  bool has_findings = false;
  const std::vector<DatasetRuns> datasets = FindRecordedRuns(files);
  const FolderBeside again(files.at("results"));
  for (const DatasetRuns& dataset : datasets) {
    std::array<size_t, kOutcomeNames.size()> counts = {};  // indexed by kind
    const auto count = [&counts](const Outcome& outcome) {
      fmt::print("{:<9}  {}{}\n", kOutcomeNames.at(static_cast<size_t>(outcome.kind)),
                 outcome.path.string(), outcome.detail.empty() ? "" : ": " + outcome.detail);
      std::fflush(stdout);  // the next run takes long
      ++counts.at(static_cast<size_t>(outcome.kind));
    };
    for (const VariantRuns& variant : dataset.variants) {
      if (variant.problem.empty()) continue;
      count({Outcome::Kind::kNotRerun, dataset.results / variant.name, variant.problem});
    }
    software_changes.merge(
        Reproduce(dataset, files.at("executables"), again.path() / dataset.name, threads, count));
    const auto [same, differ, not_rerun] = counts;
    table.rows.push_back({dataset.name, std::to_string(dataset.runs.size()), std::to_string(same),
                          std::to_string(differ), std::to_string(not_rerun)});
    has_findings = has_findings || differ + not_rerun > 0;
  }
  for (const std::string& change : software_changes) fmt::print("recorded with {}\n", change);
  fmt::print("{}", ToMarkdown(table));
  return has_findings ? kFindings : static_cast<int>(ExitCode::kDone);
}

}  // namespace soslam
