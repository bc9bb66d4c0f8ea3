// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset_files.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

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
