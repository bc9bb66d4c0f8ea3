// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace soslam {

// Kind of a path, without exceptions. Where the file system gives no answer (no access, a loop of
// links, too long a name), the path counts as missing.
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
