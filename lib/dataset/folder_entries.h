// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace soslam {

// Entries of a folder, sorted by name. Throws InputError when it cannot be listed.
std::vector<std::filesystem::path> FolderEntries(const std::filesystem::path& folder);
// Entries at any depth, sorted by name.
std::vector<std::filesystem::path> EntriesAtAnyDepth(const std::filesystem::path& folder);

}  // namespace soslam
