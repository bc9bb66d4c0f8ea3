// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "image/edge_maps.h"
#include "support/random.h"

namespace soslam {
namespace {

cv::Mat RandomEdges(int width, int height, double density) {
  cv::Mat edges = cv::Mat::zeros(height, width, CV_8UC1);
  for (auto it = edges.begin<uchar>(); it != edges.end<uchar>(); ++it) {
    if (RandomUniform(0, 1) < density) *it = 255;
  }
  return edges;
}

// Tries every edge pixel, column by column from the top left; the first of several nearest ones
// wins.
cv::Vec2s NearestByBruteForce(const cv::Mat& edges, int x, int y) {
  cv::Vec2s nearest(-1, -1);
  int least = std::numeric_limits<int>::max();
  for (int u = 0; u < edges.cols; ++u) {
    for (int v = 0; v < edges.rows; ++v) {
      const int squared = (u - x) * (u - x) + (v - y) * (v - y);
      if (edges.at<uchar>(v, u) == 0 || squared >= least) continue;
      least = squared;
      nearest = {static_cast<short>(u), static_cast<short>(v)};
    }
  }
  return nearest;
}

void ExpectExact(const cv::Mat& edges) {
  const cv::Mat nearest_edge = NearestEdgeMap(edges);
  const cv::Mat distance = DistanceMap(nearest_edge);
  ASSERT_EQ(nearest_edge.type(), CV_16SC2);
  ASSERT_EQ(distance.type(), CV_32FC1);
  for (int y = 0; y < edges.rows; ++y) {
    for (int x = 0; x < edges.cols; ++x) {
      const cv::Vec2s nearest = NearestByBruteForce(edges, x, y);
      ASSERT_EQ(nearest_edge.at<cv::Vec2s>(y, x), nearest) << x << ", " << y;
      const double expected = std::hypot(nearest[0] - x, nearest[1] - y);
      ASSERT_EQ(distance.at<float>(y, x), static_cast<float>(expected)) << x << ", " << y;
    }
  }
}

TEST(NearestEdgeTest, EqualsBruteForce) {
  for (const double density : {0.002, 0.01, 0.1, 0.5, 1.0}) {
    for (int repetition = 0; repetition < 5; ++repetition) {
      cv::Mat edges = RandomEdges(61, 47, density);
      edges.at<uchar>(11, 23) = 1;  // any value but 0 is an edge
      ExpectExact(edges);
    }
  }
}

TEST(NearestEdgeTest, OfTheLargestSides) {
  constexpr int kSide = 32767;
  cv::Mat row = cv::Mat::zeros(1, kSide, CV_8UC1);
  row.at<uchar>(0, 0) = row.at<uchar>(0, kSide - 1) = 255;
  cv::Mat column = row.t();
  for (const int i : {0, 1, kSide / 2, kSide / 2 + 1, kSide - 1}) {
    const int nearest = i <= kSide / 2 ? 0 : kSide - 1;
    EXPECT_EQ(NearestEdgeMap(row).at<cv::Vec2s>(0, i), cv::Vec2s(static_cast<short>(nearest), 0));
    EXPECT_EQ(NearestEdgeMap(column).at<cv::Vec2s>(i, 0),
              cv::Vec2s(0, static_cast<short>(nearest)));
  }
}

TEST(NearestEdgeTest, OfTwoEquallyNearTheLeftThenTheUpperWins) {
  cv::Mat edges = cv::Mat::zeros(3, 3, CV_8UC1);
  for (const auto& [x, y] : {std::pair(0, 0), {2, 0}, {0, 2}, {2, 2}}) edges.at<uchar>(y, x) = 255;
  EXPECT_EQ(NearestEdgeMap(edges).at<cv::Vec2s>(1, 1), cv::Vec2s(0, 0));
}

TEST(NearestEdgeTest, WithoutEdges) {
  const cv::Mat nearest_edge = NearestEdgeMap(cv::Mat::zeros(5, 4, CV_8UC1));
  const cv::Mat distance = DistanceMap(nearest_edge);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 4; ++x) {
      EXPECT_EQ(nearest_edge.at<cv::Vec2s>(y, x), cv::Vec2s(-1, -1));
      EXPECT_EQ(distance.at<float>(y, x), std::numeric_limits<float>::infinity());
    }
  }
}

}  // namespace
}  // namespace soslam
