// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/progress.h"

#include <gtest/gtest.h>

#include <sstream>

#include "soslam/base/parallel.h"

namespace soslam {
namespace {

class ProgressTest : public testing::Test {
 protected:
  ProgressDisplay Display(bool is_terminal) {
    return {&stream_, is_terminal, "soslam-test", [this] { return now_s_; }};
  }
  // Each step takes so long.
  void Step(Progress* progress, int steps, double step_s) {
    for (int i = 0; i < steps; ++i) {
      now_s_ += step_s;
      progress->Step();
    }
  }

  std::ostringstream stream_;
  double now_s_ = 1000.0;
};

TEST_F(ProgressTest, LinesComeEveryFiveSeconds) {
  {
    Progress progress("frames", 100, Display(false));
    Step(&progress, 100, 0.125);
  }
  EXPECT_EQ(stream_.str(),
            "soslam-test: 40/100 frames, 8/s, 8 s left\n"
            "soslam-test: 80/100 frames, 8/s, 3 s left\n");
}

TEST_F(ProgressTest, OnATerminalOneLineIsDrawnAgainAndErased) {
  {
    Progress progress("frames", 8, Display(true));
    Step(&progress, 8, 0.125);
  }
  EXPECT_EQ(stream_.str(),
            "\r\x1b[K[#####...............] 2/8 frames, 8/s, 1 s left"
            "\r\x1b[K[##########..........] 4/8 frames, 8/s, 1 s left"
            "\r\x1b[K[###############.....] 6/8 frames, 8/s, 1 s left"
            "\r\x1b[K[####################] 8/8 frames, 8/s, 0 s left"
            "\r\x1b[K");
}

TEST_F(ProgressTest, LongTimesAreMinutesAndHours) {
  Progress progress("images", 1000, Display(false));
  Step(&progress, 1, 6.0);
  Step(&progress, 1, 200.0);
  EXPECT_EQ(stream_.str(),
            "soslam-test: 1/1000 images, 0.167/s, 1 h 39 min left\n"
            "soslam-test: 2/1000 images, 0.00971/s, 28 h 33 min left\n");
}

TEST_F(ProgressTest, WithoutACountThereIsNoTimeLeft) {
  Progress progress("iterations", Progress::kUnknownCount, Display(false));
  Step(&progress, 1, 5.0);
  EXPECT_EQ(stream_.str(), "soslam-test: 1 iterations, 0.2/s\n");
}

TEST_F(ProgressTest, NoStepOfAnyThreadIsLost) {
  ProgressDisplay display = Display(false);
  display.seconds = [this] { return now_s_ += 1e-3; };  // called under the progress's lock
  Progress progress("steps", 8000, display);
  ParallelFor(8000, 4, [&](int) { progress.Step(); });
  now_s_ += 5.0;
  progress.Step();
  EXPECT_NE(stream_.str().find("soslam-test: 8001/8000 steps"), std::string::npos) << stream_.str();
}

}  // namespace
}  // namespace soslam
