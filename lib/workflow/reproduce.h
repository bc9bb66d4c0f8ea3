// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "workflow/verify.h"

namespace soslam {

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
// and compares the artefacts byte by byte. The existing results are not changed.
class Reproduction {
 public:
  // `executables`: the folder of the stages' programs; `again`: an empty folder for the new
  // outputs.
  Reproduction(const DatasetRuns& dataset, std::filesystem::path executables,
               std::filesystem::path again, int threads);

  // Repeats one run; call it in the order of the dataset's runs. Returns one outcome per artefact,
  // or one with the reason why there is none: no record, a changed external input, a failure.
  // Throws NothingUsableError when it is interrupted.
  std::vector<Outcome> Rerun(const RecordedRun& run);

  // Differences between the recorded software and this one: "opencv 4.5.4 is 4.6.0 now".
  const std::set<std::string>& software_changes() const { return software_changes_; }

 private:
  std::optional<std::string> Obstacle(const RunRecord& record, const RecordedRun& run);
  std::optional<std::string> ForeignWrite(const RunRecord& record, const RecordedRun& run) const;
  std::optional<std::string> ChangedInput(const RunRecord& record, const RecordedRun& run);
  std::optional<std::string> RunAgain(const RunRecord& record, const RecordedRun& run) const;
  std::vector<std::string> Arguments(const RunRecord& record, const RecordedRun& run) const;
  Outcome Compare(const std::filesystem::path& artefact) const;
  // True if a file is in the results of the dataset.
  bool IsResult(const std::filesystem::path& path) const;
  std::filesystem::path Again(const std::filesystem::path& path) const;

  const DatasetRuns& dataset_;
  std::filesystem::path executables_;
  std::filesystem::path again_;
  int threads_;
  FileDigests digests_;
  std::set<std::filesystem::path> rerun_;  // folders of the repeated runs
  std::set<std::string> software_changes_;
};

}  // namespace soslam
