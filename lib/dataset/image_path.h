// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace soslam {

// Path of an image that a list names relative to its dataset folder, or by an absolute path into
// it. Throws InputError, naming `place`, for a name that is empty or leads out of the folder,
// directly or through a symbolic link: a dataset from elsewhere must not make the program read
// other files of the user.
std::filesystem::path ImagePath(const std::filesystem::path& dataset, const std::string& image,
                                const std::string& place);

// The name relative to its dataset folder, if it is an absolute path into it.
std::string NameInDataset(const std::filesystem::path& dataset, const std::string& image);

// Allows images outside their dataset folder, for the whole program; not thread-safe. Initially not
// allowed.
void AllowOutsidePaths(bool is_allowed);
bool OutsidePathsAreAllowed();

}  // namespace soslam
