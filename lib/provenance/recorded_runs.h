// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "artefact/run_file.h"

namespace soslam {

// A folder of results that should have a run.json.
struct RecordedRun {
  std::string name;  // its path in the results of the dataset: "shared/refine-c664bee12d"
  std::filesystem::path folder;
  std::vector<std::string> variants;  // that use it
};

struct VariantRuns {
  std::string name;
  std::vector<std::string> runs = {};  // as in its stages.txt
  std::string problem = {};            // what is wrong with its stages.txt; empty: nothing
};

// <results>/<dataset>/: what runs left there.
struct DatasetRuns {
  std::string name;
  std::filesystem::path results;
  std::filesystem::path dataset;  // the folder of the dataset itself
  std::vector<VariantRuns> variants;
  std::vector<RecordedRun> runs;  // that variants are made of, each after those that it reads from
  std::vector<RecordedRun> exports;  // with a run.json in a folder of a variant
  std::vector<std::string> unused;   // "shared/<stage>-<key>" of which no variant is made any more
};

// Of all datasets in a results folder, by name. `data_root` has a folder for each dataset; empty:
// datasets are where they were. Throws InputError when there is no such folder, NothingUsableError
// when no dataset has results in it.
std::vector<DatasetRuns> FindRuns(const std::filesystem::path& results,
                                  const std::filesystem::path& data_root);

// Where a file of a run lies now.
std::filesystem::path PathOf(const RunFile& file, const RunRecord& record, const RecordedRun& run,
                             const DatasetRuns& dataset);

// A folder that a run was called with; that of a dataset may have moved since.
std::filesystem::path FolderOf(const std::string& argument, const RunRecord& record,
                               const DatasetRuns& dataset);

}  // namespace soslam
