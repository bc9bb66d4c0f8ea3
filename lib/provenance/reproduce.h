// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "provenance/recorded_runs.h"
#include "provenance/verify.h"

namespace soslam {

struct Outcome {
  enum class Kind { kSame, kDiffers, kNotRerun };
  Kind kind;
  std::filesystem::path path;  // an artefact; of kNotRerun the folder of the run
  std::string detail;          // where it differs, why it was not rerun
};

// The names of the arguments that a stage of the pipeline, "soslam-refine", writes to; none for any
// other program.
using WrittenArguments = std::function<std::set<std::string>(const std::string& stage)>;

// Runs what a dataset's runs were once more, with their recorded settings, each on what those
// before it wrote now, and compares the artefacts byte by byte. The results stay as they are.
class Reproduction {
 public:
  // `executables`: the folder of the stages' programs; `again`: an empty folder for what they
  // write.
  Reproduction(const DatasetRuns& dataset, std::filesystem::path executables,
               WrittenArguments written_arguments, std::filesystem::path again, int threads);

  // To be called in the order of the dataset's runs. One outcome for each artefact, or one that
  // says why there is none: no record, an input from outside that has changed, a failure. Throws
  // NothingUsableError when it is interrupted.
  std::vector<Outcome> Rerun(const RecordedRun& run);

  // How the software that was recorded differs from this one: "opencv 4.5.4 is 4.6.0 now".
  const std::set<std::string>& software_changes() const { return software_changes_; }

 private:
  std::optional<std::string> Obstacle(const RunRecord& record, const RecordedRun& run);
  std::optional<std::string> ForeignWrite(const RunRecord& record, const RecordedRun& run) const;
  std::optional<std::string> ChangedInput(const RunRecord& record, const RecordedRun& run);
  std::optional<std::string> RunAgain(const RunRecord& record, const RecordedRun& run) const;
  std::vector<std::string> Arguments(const RunRecord& record, const RecordedRun& run) const;
  Outcome Compare(const std::filesystem::path& artefact) const;
  // Whether a file lies in the results of the dataset.
  bool IsResult(const std::filesystem::path& path) const;
  std::filesystem::path Again(const std::filesystem::path& path) const;

  const DatasetRuns& dataset_;
  std::filesystem::path executables_;
  WrittenArguments written_arguments_;
  std::filesystem::path again_;
  int threads_;
  FileDigests digests_;
  std::set<std::filesystem::path> rerun_;  // folders of the runs that were
  std::set<std::string> software_changes_;
};

}  // namespace soslam
