// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace soslam {

// Absolute and without dots and a slash at its end, as it is written: links are not followed.
inline std::filesystem::path PlainPath(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

// Whether a path leads into a folder, or is it, as both are written.
inline bool IsWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return *PlainPath(path).lexically_relative(PlainPath(folder)).begin() != "..";
}

}  // namespace soslam
