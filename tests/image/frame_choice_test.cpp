// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/frame_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drawn_photos.h"

namespace soslam {
namespace {

using Reasons = std::vector<std::optional<FrameRejection>>;

FrameView DrawnFrame(int shift) { return MakeFrameView(GreyOf(DrawnView(shift))); }

Reasons ReasonsFor(const std::vector<cv::Mat>& images, const FrameOptions& options = {}) {
  FrameSelector selector(options);
  for (const cv::Mat& image : images) selector.Add(MakeFrameView(GreyOf(image)));
  return selector.Choose();
}

std::vector<size_t> ChosenOf(const Reasons& reasons) {
  std::vector<size_t> chosen;
  for (size_t i = 0; i < reasons.size(); ++i) {
    if (!reasons[i]) chosen.push_back(i);
  }
  return chosen;
}

TEST(MotionTrackerTest, MeasuresAFractionOfTheLongerSide) {
  const MotionTracker tracker(DrawnFrame(0).small);
  for (const int shift : {0, 2, 8, 32}) {
    const auto motion = tracker.MedianDisplacement(DrawnFrame(shift).small);
    ASSERT_TRUE(motion) << shift;
    EXPECT_NEAR(*motion, shift / 320.0, 0.001);  // a quarter of a pixel of the small image
  }
}

TEST(MotionTrackerTest, FindsNothingOfAnotherView) {
  const MotionTracker tracker(DrawnFrame(0).small);
  EXPECT_FALSE(tracker.MedianDisplacement(DrawnFrame(900).small));
  const cv::Mat nothing(180, 240, CV_8UC1, cv::Scalar(128));
  EXPECT_FALSE(tracker.MedianDisplacement(nothing));
  EXPECT_FALSE(MotionTracker(nothing).MedianDisplacement(nothing));
}

TEST(FrameSelectorTest, TakesTheSharpestOfOnePlace) {
  EXPECT_THAT(ChosenOf(ReasonsFor({Blurred(DrawnView(0)), DrawnView(0), Blurred(DrawnView(0)),
                                   Blurred(DrawnView(40)), DrawnView(40)})),
              testing::ElementsAre(1, 4));
}

TEST(FrameSelectorTest, ImagesThatAreAllSoftAreNotBlurred) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < 6; ++i) images.push_back(Blurred(DrawnView(20 * i)));
  EXPECT_EQ(ChosenOf(ReasonsFor(images)).size(), 6u);
}

// A camera that is held still by a hand that shakes, then moves: nearly all frames that are chosen
// are of the motion.
TEST(FrameSelectorTest, SpreadsTheChoiceOverTheMotion) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < 40; ++i) images.push_back(DrawnView(3 * (i % 2)));
  for (int i = 1; i <= 40; ++i) images.push_back(DrawnView(20 * i));
  const Reasons reasons = ReasonsFor(images, {.max_frames = 20});
  const std::vector<size_t> chosen = ChosenOf(reasons);
  EXPECT_EQ(chosen.size(), 20u);
  EXPECT_LE(std::ranges::count_if(chosen, [](size_t frame) { return frame < 40; }), 2);
  EXPECT_GE(chosen.back(), 77u);
  EXPECT_GT(std::ranges::count(reasons, FrameRejection::kOverLimit), 10);
}

TEST(FrameSelectorTest, ImagesOfNothingAreNotLeftOut) {
  const cv::Mat nothing(240, 320, CV_8UC3, cv::Scalar(128, 128, 128));
  EXPECT_EQ(ChosenOf(ReasonsFor({nothing, nothing, nothing})).size(), 3u);
  EXPECT_TRUE(ReasonsFor({}).empty());
}

}  // namespace
}  // namespace soslam
