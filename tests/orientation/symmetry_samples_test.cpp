// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/geometry/mirror_mapping.h"
#include "soslam/orientation/texture_asymmetry.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(SamplePixels, EdgesAreTheEdgePixelsInTheBoxThatShowTheBody) {
  EdgeMaps maps;
  maps.grey = cv::Mat::zeros(480, 640, CV_8UC1);
  maps.edges = cv::Mat::zeros(480, 640, CV_8UC1);
  for (int i = 0; i < 5000; ++i) {
    maps.edges.at<unsigned char>(static_cast<int>(RandomUniform(0, 480)),
                                 static_cast<int>(RandomUniform(0, 640))) = 255;
  }
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0, 0, 3}}, {0.5, 0.5, 0.5}};
  const Box box{250, 200, 400, 300};
  SymmetryOptions options;
  options.sampling = Sampling::kEdges;
  options.max_edge_pixels = 1000000;
  const VisibleSurface surface(TestCamera(), landmark);
  std::vector<Eigen::Vector2d> expected;
  for (int y = 200; y <= 300; ++y) {
    for (int x = 250; x <= 400; ++x) {
      const Eigen::Vector2d pixel(x, y);
      const bool is_edge = maps.edges.at<unsigned char>(y, x) != 0;
      if (is_edge && surface.FromPixel(pixel)) expected.push_back(pixel);
    }
  }
  EXPECT_GT(expected.size(), 50u);
  EXPECT_EQ(SamplePixels(SymmetryImage(maps, box), TestCamera(), landmark, options), expected);
  options.max_edge_pixels = 60;
  const auto thinned = SamplePixels(SymmetryImage(maps, box), TestCamera(), landmark, options);
  EXPECT_LE(thinned.size(), 60u);
  EXPECT_GT(thinned.size(), 20u);
}

TEST(SamplePixels, EdgesOfABoxOutsideTheImageAreThoseInside) {
  EdgeMaps maps;
  maps.grey = cv::Mat::zeros(480, 640, CV_8UC1);
  maps.edges = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0, 0, 3}}, {9, 9, 1}};
  SymmetryOptions options;
  options.sampling = Sampling::kEdges;
  options.max_edge_pixels = 1000000;
  const auto sample = [&](const Box& box) {
    return SamplePixels(SymmetryImage(maps, box), TestCamera(), landmark, options);
  };
  EXPECT_EQ(sample({-50, -50, 9.5, 4.5}).size(), 50u);
  EXPECT_TRUE(sample({-50, -50, -10, -5}).empty());
}

}  // namespace
}  // namespace soslam
