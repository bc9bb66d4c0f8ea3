// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {

// A dataset's folder, which the test fills, and what comes of its import.
class ImportedFolderTest : public FolderTest {
 protected:
  virtual Sequence Import() { return ImportDataset(folder_.path(), options_); }
  // Expects that the import is refused with these words.
  template <typename Error = InputError>
  void ExpectRefused(const std::vector<std::string>& words) {
    ExpectError<Error>([&] { Import(); }, words);
  }

  ImportOptions options_;
};

}  // namespace soslam
