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

// The absolute path without dots and without a slash at its end. By spelling only: links are not
// followed.
inline std::filesystem::path PlainPath(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

// True if the path is the folder or lies in it, by spelling only.
inline bool IsWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return *PlainPath(path).lexically_relative(PlainPath(folder)).begin() != "..";
}

}  // namespace soslam
