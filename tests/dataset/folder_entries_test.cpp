// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset_files.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

TEST(FolderEntriesTest, WhatCannotBeListedIsNamed) {
  const TemporaryFolder folder;
  WriteBytes(folder / "file", "");
  ExpectError<InputError>([&] { FolderEntries(folder / "file"); }, {"file: cannot be listed"});
  ExpectError<InputError>([&] { EntriesAtAnyDepth(folder / "none"); }, {"none: cannot be listed"});
}

}  // namespace
}  // namespace soslam
