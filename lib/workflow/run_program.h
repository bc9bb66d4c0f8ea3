// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace soslam {

// Runs a program to its end, with its output redirected to the file `printed`. Meanwhile interrupts
// from the terminal are handled by the program alone. Returns its exit code, or 128 plus the number
// of the signal that ended it; 127 when there is no such program.
int RunProgram(const std::vector<std::string>& words, const std::filesystem::path& printed);

}  // namespace soslam
