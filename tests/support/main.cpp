// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>

#include "support/random.h"

namespace {

// Every test starts from the same seed, whatever ran before it.
class Reseed : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { soslam::TestRandom().seed(20220101); }
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  cv::setNumThreads(1);  // as in stages
  testing::UnitTest::GetInstance()->listeners().Append(new Reseed);
  return RUN_ALL_TESTS();
}
