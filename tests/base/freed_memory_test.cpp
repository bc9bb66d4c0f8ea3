// SPDX-License-Identifier: BSD-3-Clause
#include "base/freed_memory.h"

#include <gtest/gtest.h>

#ifdef __GLIBC__
#include <malloc.h>

#include <opencv2/core/mat.hpp>

namespace soslam {
namespace {

TEST(KeepFreedMemory, AnImageStaysWhenItIsFreed) {
  if (mallinfo2().arena == 0) GTEST_SKIP() << "sanitizers have an allocator of their own";
  KeepFreedMemory();
  cv::Mat image(4096, 4096, CV_8UC1);
  const size_t bytes = image.total();
  image.release();
  EXPECT_GE(mallinfo2().fordblks, bytes);
}

}  // namespace
}  // namespace soslam
#endif
