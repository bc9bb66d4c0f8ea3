// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/edge_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/random.h"

namespace soslam {
namespace {

// A bright rectangle whose pixels are x in [20, 50), y in [10, 35) on a dark ground.
cv::Mat Rectangle() {
  cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(40));
  grey(cv::Rect(20, 10, 30, 25)) = 200;
  return grey;
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

TEST(EdgeMapsTest, EdgesAndCornersAreThoseOfTheBlurredImageWhichStaysAsItIs) {
  EdgesOptions options;
  options.blur_sigma_px = 2.0;
  const cv::Mat grey = Rectangle();
  const EdgeMaps maps = ComputeEdgeMaps(grey, options);
  EXPECT_EQ(cv::norm(grey, Rectangle(), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(maps.grey, Rectangle(), cv::NORM_INF), 0.0);
  cv::Mat blurred;
  cv::GaussianBlur(Rectangle(), blurred, cv::Size(), options.blur_sigma_px);
  options.blur_sigma_px = 0.0;
  const EdgeMaps of_blurred = ComputeEdgeMaps(blurred, options);
  EXPECT_EQ(cv::norm(maps.edges, of_blurred.edges, cv::NORM_INF), 0.0);
  EXPECT_EQ(maps.corners, of_blurred.corners);
  EXPECT_NE(maps.corners, ComputeEdgeMaps(Rectangle(), options).corners);
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

constexpr double kMinLength = 40.0;

// A bright quadrilateral on grey: four edges, none along the image's axes.
cv::Mat Quadrilateral(const std::vector<cv::Point>& corners) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(90));
  cv::fillConvexPoly(image, corners, cv::Scalar(200), cv::LINE_AA);
  return image;
}

// Half a pixel of rounding at either end of 80 px or more is less than 0.02 rad.
TEST(FindLineSegments, FindsTheEdgesOfAQuadrilateral) {
  const std::vector<cv::Point> corners = {{60, 50}, {220, 70}, {200, 190}, {80, 170}};
  const auto segments = FindLineSegments(Quadrilateral(corners), kMinLength);
  for (size_t i = 0; i < corners.size(); ++i) {
    const cv::Point edge = corners[(i + 1) % 4] - corners[i];
    const Eigen::Vector2d direction = Eigen::Vector2d(edge.x, edge.y).normalized();
    const Eigen::Vector2d corner(corners[i].x, corners[i].y);
    const auto lies_on_edge = [&](const LineSegment& segment) {
      const Eigen::Vector2d along = (segment.end - segment.begin).normalized();
      const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return std::abs(a.x() * b.y() - a.y() * b.x());
      };
      return cross(along, direction) < 0.02 && cross(segment.begin - corner, direction) < 1.5;
    };
    EXPECT_TRUE(std::any_of(segments.begin(), segments.end(), lies_on_edge)) << "edge " << i;
  }
}

TEST(FindLineSegments, LeavesOutShortOnes) {
  const std::vector<cv::Point> corners = {{60, 50}, {220, 70}, {215, 100}, {62, 80}};
  for (const LineSegment& segment : FindLineSegments(Quadrilateral(corners), kMinLength)) {
    EXPECT_GE((segment.end - segment.begin).norm(), kMinLength);
  }
}

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
