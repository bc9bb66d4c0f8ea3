// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <csignal>

#include "support/temporary_folder.h"
#include "workflow/verify.h"

namespace soslam {
namespace {

TEST(RunProgramTest, ReturnsTheExitCodeAndWritesDownWhatIsPrinted) {
  const TemporaryFolder folder;
  const std::filesystem::path printed = folder / "it's printed";
  EXPECT_EQ(RunProgram({"printf", "%s|", "a b", "it's", "$HOME"}, printed), 0);
  EXPECT_EQ(FileBytes(printed), "a b|it's|$HOME|");
  EXPECT_EQ(RunProgram({"sh", "-c", "echo oh >&2; exit 3"}, printed), 3);
  EXPECT_EQ(FileBytes(printed), "oh\n");
}

TEST(RunProgramTest, TellsSignalsAndMissingPrograms) {
  const TemporaryFolder folder;
  EXPECT_EQ(RunProgram({"sh", "-c", "kill -SEGV $$"}, folder / "printed"), 128 + SIGSEGV);
  EXPECT_EQ(RunProgram({(folder / "missing").string()}, folder / "printed"), 127);
}

}  // namespace
}  // namespace soslam
