// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace soslam {

// The file of an image that a list names relative to its dataset folder. Throws InputError, naming
// `place`, for a name that is empty or leads out of the folder.
std::filesystem::path ImagePath(const std::filesystem::path& dataset, const std::string& image,
                                const std::string& place);

}  // namespace soslam
