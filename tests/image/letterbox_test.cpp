// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "image/yolo_detector.h"
#include "support/labelled_boxes.h"

namespace soslam {
namespace {

// 640 x 480 fills 320 x 240 of 320 x 320, 40 rows below the top. A pixel of the input is two of the
// image; the image's own first pixel has its centre at 0, half a pixel from the corner.
TEST(LetterboxTest, WideImageByHand) {
  const Letterbox letterbox({640, 480}, {320, 320});
  ExpectBox(letterbox.ToImage({0, 40, 320, 280}), {-0.5, -0.5, 639.5, 479.5});
  ExpectBox(letterbox.ToImage({10, 50, 20, 65}), {19.5, 19.5, 39.5, 49.5});
}

TEST(LetterboxTest, BoxesAreCutAtTheImage) {
  const Letterbox letterbox({640, 480}, {320, 320});
  ExpectBox(letterbox.ToImage({-10, 20, 30, 400}), {-0.5, -0.5, 59.5, 479.5});
  const Box in_the_padding = letterbox.ToImage({10, 5, 30, 35});
  EXPECT_EQ(in_the_padding.Height(), 0.0);
}

TEST(LetterboxTest, FitsTheImageInGrey) {
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat fitted = Letterbox(image.size(), {320, 320}).Fit(image);
  ASSERT_EQ(fitted.size(), cv::Size(320, 320));
  const cv::Vec3b grey(114, 114, 114);
  const cv::Vec3b colour(10, 20, 30);
  for (const int x : {0, 160, 319}) {
    EXPECT_EQ(fitted.at<cv::Vec3b>(0, x), grey);
    EXPECT_EQ(fitted.at<cv::Vec3b>(39, x), grey);
    EXPECT_EQ(fitted.at<cv::Vec3b>(40, x), colour);
    EXPECT_EQ(fitted.at<cv::Vec3b>(279, x), colour);
    EXPECT_EQ(fitted.at<cv::Vec3b>(280, x), grey);
  }
}

// The two halves belong together: what is found in the fitted picture is mapped to where it was.
TEST(LetterboxTest, WhatIsFoundInTheInputIsWhereItWasInTheImage) {
  for (const cv::Size size : {cv::Size(640, 480), cv::Size(375, 1242), cv::Size(97, 83)}) {
    const cv::Rect patch(size.width / 5, size.height / 3, size.width / 2, size.height / 4);
    cv::Mat image(size, CV_8UC3, cv::Scalar::all(0));
    image(patch) = cv::Scalar::all(255);
    const Letterbox letterbox(size, {256, 256});
    cv::Mat bright;
    cv::extractChannel(letterbox.Fit(image) > 127, bright, 0);
    int x_min = 256, y_min = 256, x_max = -1, y_max = -1;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        if (bright.at<uchar>(y, x) == 0) continue;
        x_min = std::min(x_min, x), x_max = std::max(x_max, x);
        y_min = std::min(y_min, y), y_max = std::max(y_max, y);
      }
    }
    const Box found = letterbox.ToImage({x_min + 0.0, y_min + 0.0, x_max + 1.0, y_max + 1.0});
    const double pixel = std::max({1.0, size.width / 256.0, size.height / 256.0});  // of the input
    EXPECT_NEAR(found.x_min, patch.x - 0.5, 0.6 * pixel);
    EXPECT_NEAR(found.y_min, patch.y - 0.5, 0.6 * pixel);
    EXPECT_NEAR(found.x_max, patch.x + patch.width - 0.5, 0.6 * pixel);
    EXPECT_NEAR(found.y_max, patch.y + patch.height - 0.5, 0.6 * pixel);
  }
}

}  // namespace
}  // namespace soslam
