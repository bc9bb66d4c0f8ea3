// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace soslam {

// The runs, <stage>-<key>, that a stages.txt or .linked lists, in its order; none when it is not
// there. Throws InputError for what is not the name of a folder.
std::vector<std::string> RunsIn(const std::filesystem::path& list);

// The stage of a run: that of "learn-priors-0123456789" is "learn-priors".
std::string StageOf(const std::string& run);

// Why the last run in a folder failed: the first line of its file `failed`; empty when it did not.
std::string FailureIn(const std::filesystem::path& run_folder);

}  // namespace soslam
