// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/temporary_folder.h"

namespace soslam {

// Tests with a folder of their own, which is empty at first.
class FolderTest : public testing::Test {
 protected:
  // Writes a file, and the folders that it lies in; returns its path.
  std::filesystem::path Write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    return WriteBytes(path, bytes);
  }

  TemporaryFolder folder_;
};

}  // namespace soslam
