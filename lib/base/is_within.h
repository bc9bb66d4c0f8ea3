// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace soslam {

// Whether a path leads into a folder, or is it, as both are written: links are not followed.
inline bool IsWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto absolute = [](const std::filesystem::path& written) {
    return std::filesystem::absolute(written).lexically_normal();
  };
  return *absolute(path).lexically_relative(absolute(folder)).begin() != "..";
}

}  // namespace soslam
