// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace soslam {

// A folder of other people's data, none of which is part of this project: below $SOSLAM_DATA_ROOT,
// or else ../shared/data beside the project. It may be absent.
inline std::filesystem::path PublishedData(const std::string& name) {
  const char* const root = std::getenv("SOSLAM_DATA_ROOT");
  const std::filesystem::path beside = SOSLAM_SOURCE_DIR "/../shared/data";
  return (root != nullptr ? std::filesystem::path(root) : beside) / name;
}

// Skips the running test, saying what is missing.
#define SOSLAM_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path).string() << " is not there"

}  // namespace soslam
