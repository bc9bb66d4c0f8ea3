// SPDX-License-Identifier: BSD-3-Clause
#include "base/own_process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace soslam {
namespace {

TEST(OwnProcessTest, WhatEndsByItselfIsNoCrash) {
  int number = 1;
  EXPECT_FALSE(CrashInOwnProcess([&] { number = 2; }));
  EXPECT_EQ(number, 1);
  EXPECT_FALSE(CrashInOwnProcess([] { throw std::runtime_error("an error"); }));
}

TEST(OwnProcessTest, CrashesAreNamed) {
  testing::internal::CaptureStderr();
  const auto killed = CrashInOwnProcess([] { raise(SIGKILL); });
  ASSERT_TRUE(killed);
  EXPECT_EQ(*killed, "signal 9 (Killed)");
  EXPECT_TRUE(CrashInOwnProcess([] { std::abort(); }));
  EXPECT_EQ(CrashInOwnProcess([] { std::_Exit(7); }), "exit code 7");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace soslam
