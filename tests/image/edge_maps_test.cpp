// SPDX-License-Identifier: BSD-3-Clause
#include "image/edge_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "base/error.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

// A bright rectangle whose pixels are x in [20, 50), y in [10, 35) on a dark ground.
cv::Mat Rectangle() {
  cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(40));
  grey(cv::Rect(20, 10, 30, 25)) = 200;
  return grey;
}

TEST(EdgeMapsTest, AllMapsHaveTheImagesSize) {
  const EdgeMaps maps = ComputeEdgeMaps(Rectangle(), {});
  for (const cv::Mat& map : {maps.grey, maps.edges, maps.distance, maps.nearest_edge}) {
    EXPECT_EQ(map.size(), cv::Size(64, 48));
  }
  EXPECT_EQ(maps.edges.type(), CV_8UC1);
  EXPECT_EQ(maps.distance.type(), CV_32FC1);
  EXPECT_EQ(maps.nearest_edge.type(), CV_16SC2);
}

// Canny thins to one pixel on either side of the step between 19 | 20 and so on.
TEST(EdgeMapsTest, EdgesLieOnTheOutlineOfARectangle) {
  const EdgeMaps maps = ComputeEdgeMaps(Rectangle(), {});
  const double row_22_to_left = maps.distance.at<float>(22, 5);
  EXPECT_NEAR(row_22_to_left, 14.5, 0.5);  // to pixel 19 or 20
  EXPECT_NEAR(maps.distance.at<float>(22, 60), 10.5, 0.5);
  EXPECT_NEAR(maps.distance.at<float>(2, 35), 7.5, 0.5);
  EXPECT_NEAR(maps.distance.at<float>(45, 35), 10.5, 0.5);
  EXPECT_GT(cv::countNonZero(maps.edges), 90);
  EXPECT_LT(cv::countNonZero(maps.edges), 130);
}

TEST(EdgeMapsTest, DistanceAndNearestEdgeAgreeExactly) {
  const EdgeMaps maps = ComputeEdgeMaps(Rectangle(), {});
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto nearest = maps.nearest_edge.at<cv::Vec2s>(y, x);
      ASSERT_EQ(maps.edges.at<uchar>(nearest[1], nearest[0]), 255);
      ASSERT_EQ(maps.distance.at<float>(y, x),
                static_cast<float>(std::hypot(nearest[0] - x, nearest[1] - y)));
      ASSERT_EQ(maps.edges.at<uchar>(y, x) == 255, maps.distance.at<float>(y, x) == 0.0F);
    }
  }
}

TEST(EdgeMapsTest, CornersAreTheRectanglesCorners) {
  const EdgeMaps maps = ComputeEdgeMaps(Rectangle(), {});
  ASSERT_EQ(maps.corners.size(), 4U);
  for (const Eigen::Vector2f& corner : {Eigen::Vector2f(20, 10), Eigen::Vector2f(49, 10),
                                        Eigen::Vector2f(20, 34), Eigen::Vector2f(49, 34)}) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector2f& found : maps.corners) {
      nearest = std::min(nearest, (found - corner).norm());
    }
    EXPECT_LT(nearest, 1.5F) << corner.transpose();  // one pixel diagonally
  }
}

TEST(EdgeMapsTest, OptionsAreObeyed) {
  EdgesOptions options;
  options.max_corners = 2;
  EXPECT_EQ(ComputeEdgeMaps(Rectangle(), options).corners.size(), 2U);
  options.canny_low = options.canny_high = 5000.0;  // beyond any step of 160 grey values
  EXPECT_EQ(cv::countNonZero(ComputeEdgeMaps(Rectangle(), options).edges), 0);
  options.canny_low = 5001.0;
  ExpectError<SettingsError>([&] { options.Check(); }, {"canny_low", "5001", "canny_high"});
}

TEST(EdgeMapsTest, FlatAndTinyImagesHaveNoEdges) {
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(1, 1), cv::Size(1, 7), cv::Size(2, 2)}) {
    const EdgeMaps maps = ComputeEdgeMaps(cv::Mat(size, CV_8UC1, cv::Scalar(90)), {});
    EXPECT_EQ(cv::countNonZero(maps.edges), 0);
    EXPECT_EQ(maps.distance.at<float>(0, 0), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(maps.corners.empty());
    EXPECT_FALSE(NearestEdge(maps, {0, 0}));
  }
}

TEST(NearestEdgeQueryTest, RoundsToTheClosestPixelAndKnowsTheBorder) {
  EdgeMaps maps;
  maps.nearest_edge = cv::Mat(2, 3, CV_16SC2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      maps.nearest_edge.at<cv::Vec2s>(y, x) =
          cv::Vec2s(static_cast<short>(10 * x), static_cast<short>(10 * y));
    }
  }
  EXPECT_EQ(NearestEdge(maps, {1.4, 0.6}), Eigen::Vector2d(10, 10));
  EXPECT_EQ(NearestEdge(maps, {-0.5, -0.5}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(NearestEdge(maps, {2.49, 1.49}), Eigen::Vector2d(20, 10));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& outside :
       {Eigen::Vector2d(-0.51, 0), Eigen::Vector2d(2.51, 0), Eigen::Vector2d(0, -0.51),
        Eigen::Vector2d(0, 1.51), Eigen::Vector2d(nan, 0), Eigen::Vector2d(0, nan),
        Eigen::Vector2d(1e300, 0)}) {
    EXPECT_FALSE(NearestEdge(maps, outside)) << outside.transpose();
  }
}

}  // namespace
}  // namespace soslam
