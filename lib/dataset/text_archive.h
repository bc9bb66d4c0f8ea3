// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace soslam {

// A file in an archive.
struct ArchivedText {
  std::string name;  // its path in the archive
  std::string text;
};

// Reads the files of an archive (tar, also compressed; zip) whose names (ArchivedText::name) are
// `wanted`, sorted by name. Throws InputError for a file that is no archive, is truncated, or
// unpacks to more than text files would.
std::vector<ArchivedText> ReadTextArchive(
    const std::filesystem::path& path,
    const std::function<bool(const std::filesystem::path&)>& wanted);

}  // namespace soslam
