// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "image/read_image.h"

namespace soslam {
namespace {

const Camera kCamera = {64, 48, 60.0, 62.0, 31.0, 24.5};
const Distortion kLens = {-0.2, 0.05, 0.004, -0.003, 0.0};

// A grey value that says which undistorted pixel it belongs to, smooth enough to interpolate.
double Grey(const Eigen::Vector2d& pixel) {
  return 120.0 + 50.0 * std::sin(0.11 * pixel.x()) + 40.0 * std::cos(0.09 * pixel.y());
}

// What the lens makes of Grey.
cv::Mat DistortedImage() {
  cv::Mat image(kCamera.height, kCamera.width, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto pixel = UndistortPixels(kCamera, kLens, {Eigen::Vector2d(x, y)}).front();
      image.at<float>(y, x) = static_cast<float>(Grey(pixel.value()));
    }
  }
  return image;
}

TEST(ImageUndistorterTest, GivesWhatAPinholeCameraWouldSee) {
  const cv::Mat undistorted = ImageUndistorter(kCamera, kLens).Undistort(DistortedImage());
  ASSERT_EQ(undistorted.size(), cv::Size(kCamera.width, kCamera.height));
  int compared = 0;
  for (int y = 0; y < undistorted.rows; ++y) {
    for (int x = 0; x < undistorted.cols; ++x) {
      const Eigen::Vector2d source = DistortPixels(kCamera, kLens, {Eigen::Vector2d(x, y)}).front();
      if (source.x() < 0 || source.y() < 0 || source.x() > kCamera.width - 1 ||
          source.y() > kCamera.height - 1) {
        continue;
      }
      // Linear interpolation between pixels: half the second derivative over a quarter.
      EXPECT_NEAR(undistorted.at<float>(y, x), Grey({x, y}), 0.3) << x << " " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(ImageUndistorterTest, WhatTheLensDidNotSeeHasNoEdge) {
  const cv::Mat white(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(255));
  const Distortion pincushion = {0.4, 0.0, 0.0, 0.0, 0.0};  // corners come from outside
  const cv::Mat undistorted = ImageUndistorter(kCamera, pincushion).Undistort(white);
  EXPECT_EQ(cv::countNonZero(undistorted == 255), kCamera.width * kCamera.height);
}

}  // namespace
}  // namespace soslam
