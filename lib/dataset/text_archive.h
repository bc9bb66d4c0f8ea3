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

// The files of an archive (tar, also compressed; zip) whose names (ArchivedText::name) are
// `wanted`, by name. Throws InputError for what is no archive, and for one that is cut short, or
// unpacks to more than text files would.
std::vector<ArchivedText> ReadTextArchive(
    const std::filesystem::path& path,
    const std::function<bool(const std::filesystem::path&)>& wanted);

}  // namespace soslam
