// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "soslam/artefact/run_file.h"

namespace soslam {

// A folder of results that should have a run.json.
struct RecordedRun {
  std::string name;  // its path in the results of the dataset: "shared/refine-c664bee12d"
  std::filesystem::path folder;
  std::vector<std::string> variants;  // variants that use it
};

struct VariantRuns {
  std::string name;
  std::vector<std::string> runs = {};  // as in its stages.txt
  std::string problem = {};            // error in its stages.txt; empty: none
};

// All runs found in <results>/<dataset>/.
struct DatasetRuns {
  std::string name;
  std::filesystem::path results;
  std::filesystem::path dataset;  // the folder of the dataset itself
  std::vector<VariantRuns> variants;
  std::vector<RecordedRun> runs;  // runs used by variants, each after the runs that it reads from
  std::vector<RecordedRun> exports;  // with a run.json, in a folder of a variant or one level below
  std::vector<std::string> unused;   // "shared/<stage>-<key>" that no variant uses any more
};

// Runs of all datasets in a results folder, sorted by name. `data_root` has a folder for each
// dataset; empty: datasets are at their recorded place. Throws InputError when there is no such
// folder, NothingUsableError when no dataset has results in it.
std::vector<DatasetRuns> FindRuns(const std::filesystem::path& results,
                                  const std::filesystem::path& data_root);

// Current path of a file of a run.
std::filesystem::path LocateFile(const RunFile& file, const RunRecord& record,
                                 const RecordedRun& run, const DatasetRuns& dataset);

// Current path of a folder argument of a run; that of a dataset may have moved.
std::filesystem::path LocateFolder(const std::string& argument, const RunRecord& record,
                                   const DatasetRuns& dataset);

// Compares files with their recorded digests; each file is read only once.
class FileDigests {
 public:
  // "is gone", "has changed", "cannot be read"; none when the content is unchanged.
  std::optional<std::string> DescribeChange(const std::filesystem::path& path,
                                            const std::string& sha256);
  size_t files() const { return digests_.size(); }

 private:
  std::map<std::filesystem::path, std::string> digests_;  // empty: cannot be read
};

// Something that does not match its record.
struct Discrepancy {
  std::string text;                   // one line: the file and its problem
  std::vector<std::string> variants;  // variants whose results it concerns
};

struct Verification {
  std::vector<Discrepancy> discrepancies;
  size_t files = 0;  // number of compared files
};

// Compares the files of all runs of a dataset with their run.json: inputs, outputs, and the links
// of variants to them.
Verification Verify(const DatasetRuns& dataset);

// Runs a program to its end, with its output redirected to the file `printed`. Meanwhile interrupts
// from the terminal are handled by the program alone. Returns its exit code, or 128 plus the number
// of the signal that ended it; 127 when there is no such program.
int RunProgram(const std::vector<std::string>& words, const std::filesystem::path& printed);

struct Outcome {
  enum class Kind { kSame, kDiffers, kNotRerun };
  Kind kind;
  std::filesystem::path path;  // an artefact; for kNotRerun the folder of the run
  std::string detail;          // where it differs, or why it was not rerun
};

// Repeats a dataset's runs with their recorded settings, each on the new outputs of earlier runs,
// and compares the artefacts byte by byte. The existing results are not changed. `executables`: the
// folder of the stages' programs; `again`: an empty folder for the new outputs. Calls `use` with
// one outcome per artefact, or one per run with the reason why there is none: no record, a changed
// external input, a failure. Returns the differences between the recorded software and this one:
// "opencv 4.5.4 is 4.6.0 now". Throws NothingUsableError when it is interrupted.
std::set<std::string> Reproduce(const DatasetRuns& dataset,
                                const std::filesystem::path& executables,
                                const std::filesystem::path& again, int threads,
                                const std::function<void(const Outcome&)>& use);

}  // namespace soslam
