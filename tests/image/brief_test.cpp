// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "image/binary_descriptor.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;

cv::Mat RandomTexture() {
  cv::Mat grey(kHeight, kWidth, CV_8UC1);
  for (auto it = grey.begin<uchar>(); it != grey.end<uchar>(); ++it) {
    *it = static_cast<uchar>(RandomUniform(0, 256));
  }
  return grey;
}

Eigen::Vector2d RandomInnerPixel() {
  return {RandomUniform(15, kWidth - 16), RandomUniform(15, kHeight - 16)};
}

TEST(BriefTest, MirroredDescriptorAtTheMirrorPixelIsTheSame) {
  const cv::Mat grey = RandomTexture();
  cv::Mat flipped;
  cv::flip(grey, flipped, 1);
  const cv::Mat smoothed = SmoothForBrief(grey);
  const cv::Mat smoothed_flipped = SmoothForBrief(flipped);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel = RandomInnerPixel();
    const Eigen::Vector2d mirror_pixel(kWidth - 1 - pixel.x(), pixel.y());
    const auto plain = BriefDescriptor(smoothed, pixel, false);
    const auto mirrored = BriefDescriptor(smoothed_flipped, mirror_pixel, true);
    ASSERT_TRUE(plain && mirrored);
    EXPECT_EQ(*plain, *mirrored);
    EXPECT_NE(*plain, *BriefDescriptor(smoothed_flipped, mirror_pixel, false));
  }
}

TEST(BriefTest, IgnoresBrightness) {
  cv::Mat grey = RandomTexture() / 2;
  const cv::Mat brighter = grey + 100;
  const Eigen::Vector2d pixel = RandomInnerPixel();
  EXPECT_EQ(*BriefDescriptor(grey, pixel, false), *BriefDescriptor(brighter, pixel, false));
}

TEST(BriefTest, NoneWhereThePatchReachesOut) {
  const cv::Mat grey = RandomTexture();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool mirrored : {false, true}) {
    EXPECT_TRUE(BriefDescriptor(grey, {14.5, 15}, mirrored));
    EXPECT_TRUE(BriefDescriptor(grey, {kWidth - 15.6, kHeight - 15.6}, mirrored));
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(14.4, 20), Eigen::Vector2d(kWidth - 15.5, 20), Eigen::Vector2d(20, 14.4),
          Eigen::Vector2d(20, kHeight - 15.5), Eigen::Vector2d(nan, 20), Eigen::Vector2d(20, nan),
          Eigen::Vector2d(1e300, 20)}) {
      EXPECT_FALSE(BriefDescriptor(grey, pixel, mirrored)) << pixel.transpose();
    }
    EXPECT_FALSE(BriefDescriptor(cv::Mat(30, 30, CV_8UC1, cv::Scalar(0)), {15, 15}, mirrored));
  }
}

}  // namespace
}  // namespace soslam
