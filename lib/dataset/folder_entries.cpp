// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/folder_entries.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

template <typename Iterator>
std::vector<fs::path> Sorted(const fs::path& folder) {
  std::vector<fs::path> entries;
  try {
    for (const fs::directory_entry& entry : Iterator(folder)) entries.push_back(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("{}: cannot be listed ({}); expected a folder that can be read",
                                 folder.string(), error.code().message()));
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

std::vector<fs::path> FolderEntries(const fs::path& folder) {
  return Sorted<fs::directory_iterator>(folder);
}

std::vector<fs::path> EntriesAtAnyDepth(const fs::path& folder) {
  return Sorted<fs::recursive_directory_iterator>(folder);
}

}  // namespace soslam
