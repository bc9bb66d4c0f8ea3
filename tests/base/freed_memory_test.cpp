// SPDX-License-Identifier: BSD-3-Clause
#include "base/freed_memory.h"

#include <gtest/gtest.h>

#include <cstdlib>  // says which C library it is

#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 33)  // has mallinfo2
#include <malloc.h>

#include <vector>

namespace soslam {
namespace {

TEST(KeepFreedMemory, AnImageStaysWhenItIsFreed) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "sanitizers have an allocator of their own";
  KeepFreedMemory();
  constexpr size_t kBytes = size_t{16} << 20;
  std::vector<char>(kBytes, 'x');
  EXPECT_GE(mallinfo2().fordblks, kBytes);
}

}  // namespace
}  // namespace soslam
#endif
#endif
