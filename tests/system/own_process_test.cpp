// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include "soslam/system/process.h"

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

TEST(OwnProcessTest, LimitsOfTimeAndMemoryEndIt) {
  volatile unsigned steps = 0;
  const auto slow = CrashInOwnProcess(
      [&] {
        for (;;) steps = steps + 1;
      },
      {.cpu_s = 1});
  ASSERT_TRUE(slow);
  EXPECT_NE(slow->find("CPU time limit exceeded"), slow->npos) << *slow;
  const auto large = CrashInOwnProcess([] { throw std::bad_alloc(); });
  ASSERT_TRUE(large);
  EXPECT_NE(large->find("too little memory"), large->npos) << *large;
  // More addresses than the limit, none of them touched.
  EXPECT_TRUE(CrashInOwnProcess([] {
    constexpr size_t kBytes = size_t{9} << 30;
    void* bytes =
        mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (bytes == MAP_FAILED) throw std::bad_alloc();
  }));
}

TEST(FollowProgramTest, GivesEachLineAndTheExitCode) {
  std::vector<std::string> lines;
  const auto use = [&](const std::string& line) { lines.push_back(line); };
  EXPECT_EQ(
      FollowProgram({"sh", "-c", "echo \"$0\"; echo b >&2; printf end; exit 3", "a 'x'"}, use), 3);
  EXPECT_EQ(lines, (std::vector<std::string>{"a 'x'", "b", "end"}));
  EXPECT_EQ(FollowProgram({"sh", "-c", "kill -SEGV $$"}, use), 128 + SIGSEGV);
  EXPECT_EQ(FollowProgram({"no-such-program-here"}, use), std::nullopt);
}

}  // namespace
}  // namespace soslam
