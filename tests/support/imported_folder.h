// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "dataset/dataset_content.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {

// A dataset's folder, which the test fills, and what comes of its import.
class ImportedFolderTest : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    WriteBytes(folder_ / name, text);
  }
  virtual Sequence Import() { return ImportDataset(folder_, options_); }
  // Expects that the import is refused with these words.
  template <typename Error = InputError>
  void ExpectRefused(const std::vector<std::string>& words) {
    ExpectError<Error>([&] { Import(); }, words);
  }

  ImportOptions options_;
  TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_ / "small";
};

}  // namespace soslam
