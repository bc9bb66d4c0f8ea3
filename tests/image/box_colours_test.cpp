// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/box_colours.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace soslam {
namespace {

const cv::Scalar kRed(0, 0, 255), kBlue(255, 0, 0), kGrey(128, 128, 128);
constexpr Box kBox = {20.0, 10.0, 80.0, 90.0};

// The Bhattacharyya coefficient.
double Product(const BoxColours& one, const BoxColours& other) {
  return one.cast<double>().dot(other.cast<double>()) / (255.0 * 255.0);
}

cv::Mat ImageOf(const cv::Scalar& colour) { return {cv::Size(120, 100), CV_8UC3, colour}; }

TEST(ColoursInTest, TheProductIsOneForEqualAndZeroForDistantColours) {
  const BoxColours red = ColoursIn(ImageOf(kRed), kBox);
  EXPECT_NEAR(Product(red, red), 1.0, 0.02);
  EXPECT_EQ(Product(red, ColoursIn(ImageOf(kBlue), kBox)), 0.0);
}

TEST(ColoursInTest, SlightlyOtherLightIsSlightlyOtherColour) {
  const BoxColours grey = ColoursIn(ImageOf(kGrey), kBox);
  double last = 1.02;
  for (const int lighter : {0, 20, 40}) {
    const double product =
        Product(grey, ColoursIn(ImageOf(kGrey + cv::Scalar::all(lighter)), kBox));
    EXPECT_LT(product, last);
    EXPECT_GT(product, 0.6);
    last = product;
  }
}

// Half red, half blue: both have the coefficient sqrt(1/2) with the whole colour.
TEST(ColoursInTest, SharesAreThoseOfTheArea) {
  cv::Mat image = ImageOf(kRed);
  image(cv::Range::all(), cv::Range(0, 50)) = kBlue;
  const BoxColours both = ColoursIn(image, {20.0, 10.0, 79.0, 90.0});
  EXPECT_NEAR(Product(both, ColoursIn(ImageOf(kRed), kBox)), std::sqrt(0.5), 0.02);
  EXPECT_NEAR(Product(both, ColoursIn(ImageOf(kBlue), kBox)), std::sqrt(0.5), 0.02);
}

TEST(ColoursInTest, TheSizeOfTheBoxDoesNotMatter) {
  cv::Mat image = ImageOf(kRed);
  cv::circle(image, {50, 50}, 20, kBlue, cv::FILLED);
  cv::Mat twice;
  cv::resize(image, twice, {}, 2.0, 2.0, cv::INTER_NEAREST);
  const BoxColours colours = ColoursIn(image, {20.0, 20.0, 79.0, 79.0});
  EXPECT_GT(Product(colours, ColoursIn(twice, {40.0, 40.0, 159.0, 159.0})), 0.98);
}

TEST(ColoursInTest, TheMiddleCountsMost) {
  const auto framed = [](const cv::Scalar& rim) {
    cv::Mat image = ImageOf(rim);
    image(cv::Range(30, 70), cv::Range(30, 70)) = kRed;
    return ColoursIn(image, {20.0, 20.0, 79.0, 79.0});
  };
  // The middle has 44 % of the area.
  EXPECT_GT(Product(framed(kGrey), framed(kBlue)), 0.6);
}

TEST(ColoursInTest, BoxesThatReachBeyondTheImageAreCut) {
  const BoxColours red = ColoursIn(ImageOf(kRed), kBox);
  EXPECT_EQ(ColoursIn(ImageOf(kRed), {-30.0, -0.5, 119.5, 400.0}), red);
  EXPECT_EQ(ColoursIn(ImageOf(kRed), {119.2, 99.3, 119.4, 99.4}), red);
}

}  // namespace
}  // namespace soslam
