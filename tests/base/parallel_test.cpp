// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace soslam {
namespace {

class ParallelForTest : public testing::TestWithParam<int> {};

TEST_P(ParallelForTest, DoesEachOnce) {
  for (const int count : {0, 1, 2, 1000}) {
    std::vector<int> done(static_cast<size_t>(count));
    ParallelFor(count, GetParam(), [&](int i) { ++done[i]; });
    EXPECT_THAT(done, testing::Each(1));
  }
}

TEST_P(ParallelForTest, ThrowsTheFirstOfTheErrors) {
  const auto work = [&](int i) {
    if (i == 7) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // not the first in time
    if (i % 10 >= 7) throw std::runtime_error(std::to_string(i));
  };
  EXPECT_THAT([&] { ParallelFor(100, GetParam(), work); },
              testing::ThrowsMessage<std::runtime_error>("7"));
}

TEST_P(ParallelForTest, BeginsNothingMoreAfterAnError) {
  std::atomic<int> tried = 0;
  const auto work = [&](int i) {
    ++tried;
    if (i == 7) throw std::runtime_error("7");
    if (i > 7) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  EXPECT_THROW(ParallelFor(10'000, GetParam(), work), std::runtime_error);
  EXPECT_GE(tried, 8);
  EXPECT_LT(tried, 10'000);
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelForTest, testing::Values(-1, 1, 2, 16));

}  // namespace
}  // namespace soslam
