// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// The class names of a detector, the first that of class 0: one a line (classes.txt, obj.names), or
// the `names` of YOLO's data.yaml, a list or a map with all numbers from 0. In a text blank lines
// and comments (first character #) do not count. Throws InputError for a name with a comma, which
// the setting `labels` could not hold, and for a file without names.
std::vector<std::string> ReadLabelFile(const std::filesystem::path& path);
// The same of a text that is not a file of its own; `name` stands for it in error messages, and its
// extension says what it is.
std::vector<std::string> ParseLabels(const std::string& text, const std::string& name);

// Whether files of this name hold the class names in folders and archives of YOLO's labels.
bool IsLabelFile(const std::filesystem::path& name);

// The file with the class names that lies among a folder of labels, or beside it (or beside a file
// of them), or in a folder around it up to that of the dataset; none without one.
std::optional<std::filesystem::path> FindLabelFile(const std::filesystem::path& labels,
                                                   const std::filesystem::path& dataset);

}  // namespace soslam
