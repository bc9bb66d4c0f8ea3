// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

TEST(FolderEntriesTest, WhatCannotBeListedIsNamed) {
  const TemporaryFolder folder;
  WriteBytes(folder / "file", "");
  ExpectError<InputError>([&] { FolderEntries(folder / "file"); }, {"file: cannot be listed"});
  ExpectError<InputError>([&] { FolderEntries(folder / "none"); }, {"none: cannot be listed"});
}

bool IsText(const std::filesystem::path& name) { return name.extension() == ".txt"; }

const std::filesystem::path kArchives = SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/box_archives";

TEST(TextArchiveTest, WhatUnpacksToTooMuchIsRefused) {
  for (const char* archive : {"unpacks_to_70_mb.tar.bz2", "unpacks_to_300_mb.tar.gz.gz"}) {
    ExpectError<InputError>([&] { ReadTextArchive(kArchives / archive, &IsText); },
                            {archive, "unpacks to", "expected at most"});
  }
}

}  // namespace
}  // namespace soslam
