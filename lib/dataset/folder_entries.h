// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace soslam {

// What is in a folder, by name. Throws InputError when the system does not let it be listed.
std::vector<std::filesystem::path> FolderEntries(const std::filesystem::path& folder);
// The same at any depth.
std::vector<std::filesystem::path> EntriesAtAnyDepth(const std::filesystem::path& folder);

}  // namespace soslam
