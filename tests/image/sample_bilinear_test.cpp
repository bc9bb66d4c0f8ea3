// SPDX-License-Identifier: BSD-3-Clause
#include "image/sample_bilinear.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "support/random.h"

namespace soslam {
namespace {

// A bilinear function is reproduced between pixels; the tolerances are float rounding of the map.
TEST(SampleBilinearTest, ReproducesABilinearFunctionAndItsGradient) {
  cv::Mat map(20, 30, CV_32FC1);
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.cols; ++x) {
      map.at<float>(y, x) = static_cast<float>(3.0 + 0.5 * x - 0.25 * y + 0.125 * x * y);
    }
  }
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel(RandomUniform(0, 29), RandomUniform(0, 19));
    const auto sample = SampleBilinear(map, pixel);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->value,
                3.0 + 0.5 * pixel.x() - 0.25 * pixel.y() + 0.125 * pixel.x() * pixel.y(), 1e-5);
    EXPECT_NEAR(sample->gradient.x(), 0.5 + 0.125 * pixel.y(), 1e-5);
    EXPECT_NEAR(sample->gradient.y(), -0.25 + 0.125 * pixel.x(), 1e-5);
  }
}

TEST(SampleBilinearTest, ReachesExactlyToTheLastPixelCentres) {
  const cv::Mat map = (cv::Mat_<float>(2, 2) << 1, 2, 3, 5);
  EXPECT_EQ(SampleBilinear(map, {0, 0})->value, 1.0);
  EXPECT_EQ(SampleBilinear(map, {1, 1})->value, 5.0);
  EXPECT_EQ(SampleBilinear(map, {1, 1})->gradient, Eigen::Vector2d(2, 3));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& outside :
       {Eigen::Vector2d(-1e-9, 0), Eigen::Vector2d(1 + 1e-9, 0), Eigen::Vector2d(0, -1e-9),
        Eigen::Vector2d(0, 1 + 1e-9), Eigen::Vector2d(nan, 0), Eigen::Vector2d(0, nan),
        Eigen::Vector2d(1e300, 0)}) {
    EXPECT_FALSE(SampleBilinear(map, outside)) << outside.transpose();
  }
}

TEST(SampleBilinearTest, NothingFromInfiniteOrOneColumnMaps) {
  const float infinity = std::numeric_limits<float>::infinity();
  const cv::Mat map = (cv::Mat_<float>(2, 3) << 1, 2, infinity, 3, 5, 1);
  EXPECT_TRUE(SampleBilinear(map, {0.5, 0.5}));
  EXPECT_FALSE(SampleBilinear(map, {1.5, 0.5}));
  EXPECT_FALSE(SampleBilinear(cv::Mat(5, 1, CV_8UC1, cv::Scalar(3)), {0, 2}));
  EXPECT_FALSE(SampleBilinear(cv::Mat(1, 5, CV_8UC1, cv::Scalar(3)), {2, 0}));
}

}  // namespace
}  // namespace soslam
