// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/system/run_log.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "soslam/base/error.h"
#include "soslam/system/hash.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class RunLogTest : public FolderTest {
 protected:
  RunLogTest() : input_(folder_ / "input.txt") { WriteBytes(input_, "before"); }

  // Replaces the file like programs that write a whole file under another name first.
  void Replace(const std::string& bytes) const {
    Write("new", bytes);
    fs::rename(folder_ / "new", input_);
  }

  fs::path input_;
};

TEST_F(RunLogTest, NothingIsNotedWithoutALog) {
  RecordInput(input_);
  NoteSeed(3);
  EXPECT_EQ(DigestOfInput(input_), Sha256OfText("before"));
  Replace("after");
  EXPECT_NO_THROW(CheckInputsUnchanged());
  const RunLog log;
  EXPECT_TRUE(log.Inputs().empty());
  EXPECT_TRUE(log.Outputs().empty());
  EXPECT_FALSE(log.Seed());
}

TEST_F(RunLogTest, TheDigestOfAnInputIsThatOfWhenItWasRead) {
  const RunLog log;
  RecordInput(input_);
  Replace("after");
  RecordInput(folder_.path() / "." / "input.txt");
  EXPECT_EQ(DigestOfInput(input_), Sha256OfText("before"));
  EXPECT_EQ(Only(log.Inputs()).sha256, Sha256OfText("before"));
}

TEST_F(RunLogTest, WhatCannotBeReadIsNotNoted) {
  const RunLog log;
  RecordInput(folder_ / "missing.txt");
  RecordInput(folder_.path());
  EXPECT_TRUE(log.Inputs().empty());
  ExpectError<InputError>([&] { DigestOfInput(folder_ / "missing.txt"); }, {"missing.txt"});
}

TEST_F(RunLogTest, RefusesInputsThatChanged) {
  const RunLog log;
  RecordInput(input_);
  EXPECT_NO_THROW(CheckInputsUnchanged());
  Replace("AFTERW");  // of the same size
  ExpectError<InputError>([] { CheckInputsUnchanged(); }, {"input.txt", "was changed"});
  fs::remove(input_);
  ExpectError<InputError>([] { CheckInputsUnchanged(); }, {"input.txt", "was removed"});
  Replace("before");
  EXPECT_NO_THROW(CheckInputsUnchanged()) << "the same content in another file is the same input";
}

TEST_F(RunLogTest, AnInputThatTheRunReplacesItselfMayChange) {
  const RunLog log;
  RecordInput(input_);
  Replace("after");
  RecordOutput(input_);
  EXPECT_NO_THROW(CheckInputsUnchanged());
}

}  // namespace
}  // namespace soslam
