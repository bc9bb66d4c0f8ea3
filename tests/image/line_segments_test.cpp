// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "image/edge_maps.h"

namespace soslam {
namespace {

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

TEST(FindLineSegments, FindsNothingInAPlainImage) {
  EXPECT_TRUE(FindLineSegments(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), kMinLength).empty());
}

}  // namespace
}  // namespace soslam
