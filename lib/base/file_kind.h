// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace soslam {

// What a path leads to. Where the file system will not say (no access, a circle of links, a name
// that is too long), it leads to nothing.
inline bool Exists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}
inline bool IsFolder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}
inline bool IsFile(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace soslam
