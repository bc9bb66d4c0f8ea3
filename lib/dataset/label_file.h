// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace soslam {

// The class names of a detector, one a line, the first that of class 0. Blank lines and comments
// (first character #) do not count. Throws InputError for a name with a comma, which a CSV file
// could not hold, and for a file without names.
std::vector<std::string> ReadLabelFile(const std::filesystem::path& path);

}  // namespace soslam
