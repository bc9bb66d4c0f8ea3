// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset_files.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

bool IsText(const std::filesystem::path& name) { return name.extension() == ".txt"; }

const std::filesystem::path kArchives = SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/box_archives";

TEST(TextArchiveTest, FilesOfTheExtensionAreRead) {
  for (const char* archive : {"fractions.zip", "fractions.tar.gz"}) {
    const auto texts = ReadTextArchive(kArchives / archive, &IsText);
    ASSERT_EQ(texts.size(), 2U) << archive;
    EXPECT_EQ(texts[0].name, "labels/a.txt");
    EXPECT_EQ(texts[0].text, "0 0.5 0.5 0.2 0.2 0.9\n");
    EXPECT_TRUE(ReadTextArchive(kArchives / archive, [](const auto&) { return false; }).empty());
  }
}

TEST(TextArchiveTest, WhatUnpacksToTooMuchIsRefused) {
  for (const char* archive : {"unpacks_to_70_mb.tar.bz2", "unpacks_to_300_mb.tar.gz.gz"}) {
    ExpectError<InputError>([&] { ReadTextArchive(kArchives / archive, &IsText); },
                            {archive, "unpacks to", "expected at most"});
  }
}

}  // namespace
}  // namespace soslam
