// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/report/results_tree.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShared = "shared";

RecordedRun* Find(const std::string& name, std::vector<RecordedRun>* runs) {
  const auto found = std::ranges::find(*runs, name, &RecordedRun::name);
  return found == runs->end() ? nullptr : &*found;
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
  return ReadDatasetFolder(dataset.results);
}

DatasetRuns RunsOfDataset(const std::string& name, const fs::path& results,
                          const fs::path& data_root) {
  DatasetRuns dataset = {name, (results / name).lexically_normal(), data_root / name, {}, {}, {},
                         {}};
  for (const std::string& folder : ListSubfolders(dataset.results)) {
    VariantRuns variant = {folder};
    try {
      variant.runs = RunsIn(dataset.results / folder / "stages.txt");
    } catch (const InputError& error) {
      variant.problem = error.what();
    }
    if (variant.runs.empty() && variant.problem.empty()) continue;
    dataset.variants.push_back(std::move(variant));
  }
  // Each variant lists its runs in order, so each run comes after the runs that it reads from.
  for (const VariantRuns& variant : dataset.variants) {
    for (const std::string& id : variant.runs) {
      const std::string shared = std::string(kShared) + "/" + id;
      RecordedRun* known = Find(shared, &dataset.runs);
      if (known == nullptr) {
        known = &dataset.runs.emplace_back(RecordedRun{shared, dataset.results / shared, {}});
      }
      known->variants.push_back(variant.name);
    }
  }
  if (data_root.empty()) dataset.dataset = FolderOfDataset(dataset);
  for (const std::string& folder : ListSubfolders(dataset.results / kShared)) {
    const std::string shared = std::string(kShared) + "/" + folder;
    if (Find(shared, &dataset.runs) == nullptr) dataset.unused.push_back(shared);
  }
  for (const VariantRuns& variant : dataset.variants) {
    for (const std::string& folder : ListSubfolders(dataset.results / variant.name)) {
      std::vector<std::string> runs = {variant.name + "/" + folder};
      for (const std::string& inner : ListSubfolders(dataset.results / runs.front())) {
        runs.push_back(runs.front() + "/" + inner);
      }
      for (const std::string& run : runs) {
        if (!Exists(dataset.results / run / "run.json")) continue;
        dataset.exports.push_back({run, dataset.results / run, {variant.name}});
      }
    }
  }
  return dataset;
}

}  // namespace

std::vector<DatasetRuns> FindRuns(const fs::path& results, const fs::path& data_root) {
  if (!IsFolder(results)) {
    throw InputError(results.string() + ": is no folder; expected results of runs");
  }
  std::vector<DatasetRuns> datasets;
  for (const std::string& name : ListSubfolders(results)) {
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

fs::path LocateFolder(const std::string& argument, const RunRecord& record,
                      const DatasetRuns& dataset) {
  const bool is_known_dataset = argument == "dataset" && !dataset.dataset.empty();
  return is_known_dataset ? dataset.dataset : AsCalled(record.folders.at(argument), record);
}

fs::path LocateFile(const RunFile& file, const RunRecord& record, const RecordedRun& run,
                    const DatasetRuns& dataset) {
  if (file.relative_to == kRelativeToRun) return (run.folder / file.path).lexically_normal();
  if (file.relative_to == kRelativeToCall) return AsCalled(file.path, record).lexically_normal();
  return (LocateFolder(file.relative_to, record, dataset) / file.path).lexically_normal();
}

namespace {

bool IsDatasetGone(const DatasetRuns& dataset) {
  return !dataset.dataset.empty() && !IsFolder(dataset.dataset);
}

Discrepancy MakeDiscrepancy(const fs::path& file, const std::string& problem,
                            const std::vector<std::string>& variants) {
  return {fmt::format("{}: {}", file.string(), problem), variants};
}

// Compares a run with its record; `record` is left empty if the run has none.
void CheckRun(const DatasetRuns& dataset, const RecordedRun& run, FileDigests* digests,
              RunRecord* record, std::vector<Discrepancy>* found) {
  const auto add = [&](const fs::path& file, const std::string& problem) {
    found->push_back(MakeDiscrepancy(file, problem, run.variants));
  };
  const std::string failure = FailureIn(run.folder);
  if (!failure.empty()) add(run.folder, "its last run failed: " + failure);
  const fs::path file = run.folder / "run.json";
  if (!Exists(file)) {
    return add(file, "is missing: the stage has not run, or its record was removed");
  }
  const auto check = [&](const RunFile& of_run, const char* what_it_did) {
    if (of_run.relative_to == "dataset" && IsDatasetGone(dataset)) return;
    const fs::path path = LocateFile(of_run, *record, run, dataset);
    if (const auto change = digests->DescribeChange(path, of_run.sha256)) {
      add(path, fmt::format("{} since {} {} it", *change, run.name, what_it_did));
    }
  };
  try {
    *record = ReadRun(file);
    if (record->exit_code == 0 && record->outputs.empty()) {
      add(file, "has no outputs; expected those of a run that did not fail");
    } else if (record->exit_code == 0) {
      for (const RunFile& output : record->outputs) check(output, "wrote");
      for (const RunFile& input : record->inputs) check(input, "read");
    } else if (failure.empty()) {
      add(run.folder, "its last run failed: " + record->error);
    }
  } catch (const InputError& error) {
    found->push_back({error.what(), run.variants});
  }
}

// Checks that the folder of a variant links the artefacts of its runs, the last one of each name,
// and has no other files. `records`: by name of the run.
void CheckVariant(const DatasetRuns& dataset, const VariantRuns& variant,
                  const std::map<std::string, RunRecord>& records,
                  std::vector<Discrepancy>* found) {
  if (!variant.problem.empty()) return found->push_back({variant.problem, {variant.name}});
  std::map<fs::path, std::string> makers;  // file name -> run
  bool are_known = true;                   // the outputs of all its runs are known
  for (const std::string& id : variant.runs) {
    const std::string run = "shared/" + id;
    const std::vector<RunFile>& outputs = records.at(run).outputs;
    for (const RunFile& output : outputs) makers[output.path] = run;
    are_known = are_known && !outputs.empty();
  }
  const fs::path folder = dataset.results / variant.name;
  std::error_code not_there;
  for (const auto& [file, run] : makers) {
    if (fs::equivalent(folder / file, dataset.results / run / file, not_there)) continue;
    const bool is_there = Exists(folder / file);
    found->push_back(MakeDiscrepancy(
        folder / file, is_there ? "is not the one of " + run : "is gone; expected that of " + run,
        {variant.name}));
  }
  if (!are_known) return;
  std::set<fs::path> strangers;
  for (const auto& entry : fs::directory_iterator(folder, not_there)) {
    const fs::path name = entry.path().filename();
    const bool is_of_make = name == "stages.txt" || name.string().starts_with('.');
    if (IsFolder(entry.path()) || is_of_make || makers.contains(name)) continue;
    strangers.insert(entry.path());
  }
  for (const fs::path& file : strangers) {
    found->push_back(MakeDiscrepancy(file, "no run of the variant wrote it", {variant.name}));
  }
}

}  // namespace

std::optional<std::string> FileDigests::DescribeChange(const fs::path& path,
                                                       const std::string& sha256) {
  auto digest = digests_.find(path);
  if (digest == digests_.end()) {
    digest = digests_.emplace(path, "").first;  // empty where it cannot be read
    try {
      if (IsFile(path)) digest->second = Sha256OfFile(path);
    } catch (const InputError&) {
    }
  }
  if (digest->second == sha256) return std::nullopt;
  if (!digest->second.empty()) return "has changed";
  return IsFile(path) ? "cannot be read" : "is gone";
}

Verification Verify(const DatasetRuns& dataset) {
  Verification result;
  std::vector<Discrepancy>* found = &result.discrepancies;
  if (IsDatasetGone(dataset)) {  // one discrepancy instead of one for each of its files
    std::vector<std::string> all;
    for (const VariantRuns& variant : dataset.variants) all.push_back(variant.name);
    found->push_back(MakeDiscrepancy(dataset.dataset,
                                     "the dataset is not there; its files are not compared", all));
  }
  FileDigests digests;
  std::map<std::string, RunRecord> records;
  for (const auto* runs : {&dataset.runs, &dataset.exports}) {
    for (const RecordedRun& run : *runs) {
      CheckRun(dataset, run, &digests, &records[run.name], found);
    }
  }
  for (const VariantRuns& variant : dataset.variants) {
    CheckVariant(dataset, variant, records, found);
  }
  result.files = digests.files();
  return result;
}

}  // namespace soslam
