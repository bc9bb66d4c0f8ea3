// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/verify.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/hash.h"
#include "report/results_tree.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// SHA-256 of a file; empty when it cannot be read.
std::string DigestOf(const fs::path& path) {
  try {
    return IsFile(path) ? Sha256OfFile(path) : "";
  } catch (const InputError&) {
    return "";
  }
}

class Verifier {
 public:
  explicit Verifier(const DatasetRuns& dataset)
      : dataset_(dataset),
        is_dataset_gone_(!dataset.dataset.empty() && !IsFolder(dataset.dataset)) {}

  Verification Verify() {
    if (is_dataset_gone_) AddDataset();
    for (const RecordedRun& run : dataset_.runs) CheckRun(run);
    for (const RecordedRun& run : dataset_.exports) CheckRun(run);
    for (const VariantRuns& variant : dataset_.variants) CheckVariant(variant);
    result_.files = digests_.files();
    return std::move(result_);
  }

 private:
  void Add(const fs::path& file, const std::string& problem,
           const std::vector<std::string>& variants) {
    result_.discrepancies.push_back({fmt::format("{}: {}", file.string(), problem), variants});
  }

  // Adds one discrepancy for a missing dataset instead of one for each of its files.
  void AddDataset() {
    std::vector<std::string> all;
    for (const VariantRuns& variant : dataset_.variants) all.push_back(variant.name);
    Add(dataset_.dataset, "the dataset is not there; its files are not compared", all);
  }

  void CheckRun(const RecordedRun& run) {
    const std::string failure = FailureIn(run.folder);
    if (!failure.empty()) Add(run.folder, "its last run failed: " + failure, run.variants);
    const fs::path file = run.folder / "run.json";
    if (!Exists(file)) {
      Add(file, "is missing: the stage has not run, or its record was removed", run.variants);
      return;
    }
    try {
      const RunRecord& record = records_[run.name] = ReadRun(file);
      if (record.exit_code == 0 && record.outputs.empty()) {
        Add(file, "has no outputs; expected those of a run that did not fail", run.variants);
      } else if (record.exit_code == 0) {
        CheckFiles(run, record);
      } else if (failure.empty()) {
        Add(run.folder, "its last run failed: " + record.error, run.variants);
      }
    } catch (const InputError& error) {
      result_.discrepancies.push_back({error.what(), run.variants});
    }
  }

  void CheckFiles(const RecordedRun& run, const RunRecord& record) {
    const auto check = [&](const RunFile& file, const char* what_it_did) {
      if (file.relative_to == "dataset" && is_dataset_gone_) return;
      const fs::path path = PathOf(file, record, run, dataset_);
      if (const auto change = digests_.ChangeOf(path, file.sha256)) {
        Add(path, fmt::format("{} since {} {} it", *change, run.name, what_it_did), run.variants);
      }
    };
    for (const RunFile& output : record.outputs) check(output, "wrote");
    for (const RunFile& input : record.inputs) check(input, "read");
  }

  // Checks that the folder of a variant links the artefacts of its runs, the last one of each name.
  void CheckVariant(const VariantRuns& variant) {
    if (!variant.problem.empty()) {
      result_.discrepancies.push_back({variant.problem, {variant.name}});
      return;
    }
    std::map<fs::path, std::string> makers;  // file name -> run
    bool are_known = true;                   // the outputs of all its runs are known
    for (const std::string& id : variant.runs) {
      const std::string run = "shared/" + id;
      const std::vector<RunFile>& outputs = records_[run].outputs;
      for (const RunFile& output : outputs) makers[output.path] = run;
      are_known = are_known && !outputs.empty();
    }
    for (const auto& [file, run] : makers) {
      const fs::path link = dataset_.results / variant.name / file;
      std::error_code not_there;
      if (fs::equivalent(link, dataset_.results / run / file, not_there)) continue;
      Add(link, Exists(link) ? "is not the one of " + run : "is gone; expected that of " + run,
          {variant.name});
    }
    if (are_known) CheckStrangers(variant, makers);
  }

  void CheckStrangers(const VariantRuns& variant, const std::map<fs::path, std::string>& makers) {
    std::set<fs::path> strangers;
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(dataset_.results / variant.name, not_there)) {
      const fs::path name = entry.path().filename();
      const bool is_of_make = name == "stages.txt" || name.string().starts_with('.');
      if (IsFolder(entry.path()) || is_of_make || makers.contains(name)) continue;
      strangers.insert(entry.path());
    }
    for (const fs::path& file : strangers) {
      Add(file, "no run of the variant wrote it", {variant.name});
    }
  }

  const DatasetRuns& dataset_;
  bool is_dataset_gone_;
  FileDigests digests_;
  std::map<std::string, RunRecord> records_;  // keyed by name of the run; empty where it has none
  Verification result_;
};

}  // namespace

std::optional<std::string> FileDigests::ChangeOf(const fs::path& path, const std::string& sha256) {
  auto digest = digests_.find(path);
  if (digest == digests_.end()) {
    digest = digests_.emplace(path, DigestOf(path)).first;
  }
  if (digest->second == sha256) return std::nullopt;
  if (!digest->second.empty()) return "has changed";
  return IsFile(path) ? "cannot be read" : "is gone";
}

Verification Verify(const DatasetRuns& dataset) { return Verifier(dataset).Verify(); }

}  // namespace soslam
