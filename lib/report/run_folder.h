// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace soslam {

// The runs, <stage>-<key>, that a stages.txt or .linked lists, in its order; empty if the file does
// not exist. Throws InputError for an entry that is not the name of a folder.
std::vector<std::string> RunsIn(const std::filesystem::path& list);

// The stage of a run: "learn-priors" for "learn-priors-0123456789".
std::string StageOf(const std::string& run);

// Error of the last run in a folder: the first line of its file `failed`; empty if it did not fail.
std::string FailureIn(const std::filesystem::path& run_folder);

}  // namespace soslam
