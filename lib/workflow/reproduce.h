// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
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
