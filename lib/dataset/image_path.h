// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace soslam {

// The file of an image that a list names relative to its dataset folder, or by an absolute path
// into it. Throws InputError, naming `place`, for a name that is empty or leads out of the folder,
// by itself or through a symbolic link: a dataset from elsewhere must not have other files of its
// user read.
std::filesystem::path ImagePath(const std::filesystem::path& dataset, const std::string& image,
                                const std::string& place);

// The name relative to its dataset folder, where it is an absolute path into that.
std::string NameInDataset(const std::filesystem::path& dataset, const std::string& image);

// Whether images may lie outside their dataset folder all the same, for the whole program; not
// while threads are running. At first they may not.
void AllowOutsidePaths(bool is_allowed);
bool OutsidePathsAreAllowed();

}  // namespace soslam
