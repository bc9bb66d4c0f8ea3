// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/recorded_runs.h"

#include <algorithm>

#include "base/error.h"
#include "base/file_kind.h"
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

}  // namespace soslam
