// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/paths.h"
#include "report/results_tree.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShared = "shared";

RecordedRun* Find(const std::string& name, std::vector<RecordedRun>* runs) {
  const auto found = std::ranges::find(*runs, name, &RecordedRun::name);
  return found == runs->end() ? nullptr : &*found;
}

// Appends the runs of all variants. Each variant lists its runs in order, so each run comes after
// the runs that it reads from.
void AppendSharedRuns(DatasetRuns* dataset) {
  for (const VariantRuns& variant : dataset->variants) {
    for (const std::string& id : variant.runs) {
      const std::string name = std::string(kShared) + "/" + id;
      RecordedRun* known = Find(name, &dataset->runs);
      if (known == nullptr) {
        known = &dataset->runs.emplace_back(RecordedRun{name, dataset->results / name, {}});
      }
      known->variants.push_back(variant.name);
    }
  }
}

void AppendExports(DatasetRuns* dataset) {
  for (const VariantRuns& variant : dataset->variants) {
    for (const std::string& folder : SubfoldersOf(dataset->results / variant.name)) {
      const std::string name = variant.name + "/" + folder;
      if (!Exists(dataset->results / name / "run.json")) continue;
      dataset->exports.push_back({name, dataset->results / name, {variant.name}});
    }
  }
}

// Resolves a relative path of a call in the folder of that call, if it still exists.
fs::path AsCalled(const fs::path& path, const RunRecord& record) {
  return IsFolder(record.called_in) ? record.called_in / path : path;
}

// Folder of the dataset as recorded by the runs; if that no longer exists, as recorded by the plan.
fs::path FolderOfDataset(const DatasetRuns& dataset) {
  for (const RecordedRun& run : dataset.runs) {
    try {
      const RunRecord record = ReadRun(run.folder / "run.json");
      const auto folder = record.folders.find("dataset");
      if (folder == record.folders.end()) continue;
      fs::path called = AsCalled(folder->second, record);
      if (IsFolder(called)) return called;
    } catch (const InputError&) {
      continue;  // reported when the run is compared
    }
  }
  return DatasetFolderOf(dataset.results);
}

DatasetRuns RunsOfDataset(const std::string& name, const fs::path& results,
                          const fs::path& data_root) {
  DatasetRuns dataset = {name, (results / name).lexically_normal(), data_root / name, {}, {}, {},
                         {}};
  for (const std::string& folder : SubfoldersOf(dataset.results)) {
    VariantRuns variant = {folder};
    try {
      variant.runs = RunsIn(dataset.results / folder / "stages.txt");
    } catch (const InputError& error) {
      variant.problem = error.what();
    }
    if (variant.runs.empty() && variant.problem.empty()) continue;
    dataset.variants.push_back(std::move(variant));
  }
  AppendSharedRuns(&dataset);
  if (data_root.empty()) dataset.dataset = FolderOfDataset(dataset);
  for (const std::string& folder : SubfoldersOf(dataset.results / kShared)) {
    const std::string shared = std::string(kShared) + "/" + folder;
    if (Find(shared, &dataset.runs) == nullptr) dataset.unused.push_back(shared);
  }
  AppendExports(&dataset);
  return dataset;
}

}  // namespace

std::vector<DatasetRuns> FindRuns(const fs::path& results, const fs::path& data_root) {
  if (!IsFolder(results)) {
    throw InputError(results.string() + ": is no folder; expected results of runs");
  }
  std::vector<DatasetRuns> datasets;
  for (const std::string& name : SubfoldersOf(results)) {
    DatasetRuns dataset = RunsOfDataset(name, results, data_root);
    if (dataset.variants.empty() && dataset.unused.empty()) continue;
    datasets.push_back(std::move(dataset));
  }
  if (datasets.empty()) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/<variant>/stages.txt; expected at least one");
  }
  return datasets;
}

fs::path FolderOf(const std::string& argument, const RunRecord& record,
                  const DatasetRuns& dataset) {
  const bool is_known_dataset = argument == "dataset" && !dataset.dataset.empty();
  return is_known_dataset ? dataset.dataset : AsCalled(record.folders.at(argument), record);
}

fs::path PathOf(const RunFile& file, const RunRecord& record, const RecordedRun& run,
                const DatasetRuns& dataset) {
  if (file.relative_to == kRelativeToRun) return (run.folder / file.path).lexically_normal();
  if (file.relative_to == kRelativeToCall) return AsCalled(file.path, record).lexically_normal();
  return (FolderOf(file.relative_to, record, dataset) / file.path).lexically_normal();
}

namespace {

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
