// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "inspection/canvas.h"

namespace soslam {
namespace {

constexpr int kSize = kPictureWidth;  // so that pictures are not enlarged

// One vertical edge in the middle, and a corner.
EdgeMaps MapsOfAnEdge() {
  EdgeMaps maps;
  maps.grey = cv::Mat(kSize, kSize, CV_8UC1, cv::Scalar(50));
  maps.edges = cv::Mat::zeros(kSize, kSize, CV_8UC1);
  maps.edges.col(kSize / 2) = 255;
  maps.distance = cv::Mat(kSize, kSize, CV_32FC1);
  maps.nearest_edge = cv::Mat(kSize, kSize, CV_16SC2);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      maps.distance.at<float>(y, x) = static_cast<float>(std::abs(x - kSize / 2));
      maps.nearest_edge.at<cv::Vec2s>(y, x) = {kSize / 2, static_cast<short>(y)};
    }
  }
  maps.corners = {{100.0F, 200.0F}};
  return maps;
}

// Blue, green, red at (x, y).
cv::Vec3b At(const cv::Mat& picture, int x, int y) { return picture.at<cv::Vec3b>(y, x); }

int Brightness(const cv::Vec3b& colour) { return colour[0] + colour[1] + colour[2]; }

TEST(PicturesTest, EveryLayerShowsItsMap) {
  const EdgeMaps maps = MapsOfAnEdge();
  const auto picture = [&](EdgeLayer layer) { return EdgesPicture(maps, layer, "frame 1"); };
  const cv::Mat grey = picture(EdgeLayer::kGrey);
  EXPECT_EQ(At(grey, 10, 10), cv::Vec3b(50, 50, 50));
  EXPECT_EQ(At(grey, 100, 200), cv::Vec3b(66, 228, 240)) << "the corner";
  const cv::Mat edges = picture(EdgeLayer::kEdges);
  EXPECT_EQ(At(edges, kSize / 2, 10), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(At(edges, 10, 10), cv::Vec3b(0, 0, 0));
  const cv::Mat distance = picture(EdgeLayer::kDistance);
  EXPECT_GT(Brightness(At(distance, 0, 10)), Brightness(At(distance, kSize / 2, 10)) + 100);
  const cv::Mat nearest = picture(EdgeLayer::kNearest);
  EXPECT_GT(At(nearest, 10, 10)[2], At(nearest, 10, 10)[0]) << "red: the edge is to the right";
  EXPECT_LT(At(nearest, kSize - 10, 10)[2], At(nearest, kSize - 10, 10)[0]) << "cyan: to the left";
  EXPECT_GT(nearest.rows, kSize) << "there is a caption";
}

TEST(PicturesTest, AllLayersAreSideBySide) {
  const cv::Mat all = EdgesPicture(MapsOfAnEdge(), EdgeLayer::kAll, "frame 1");
  EXPECT_EQ(all.cols, 2 * kSize);
  EXPECT_EQ(At(all, kSize + kSize / 2, 10), cv::Vec3b(255, 255, 255));
}

TEST(PicturesTest, AnImageWithoutEdgesIsDark) {
  const EdgeMaps maps = ComputeEdgeMaps(cv::Mat(kSize, kSize, CV_8UC1, cv::Scalar(50)), {});
  const cv::Mat nearest = EdgesPicture(maps, EdgeLayer::kNearest, "");
  EXPECT_EQ(At(nearest, 10, 10), cv::Vec3b(0, 0, 0));
  const cv::Mat distance = EdgesPicture(maps, EdgeLayer::kDistance, "");
  EXPECT_EQ(At(distance, 10, 10), At(distance, kSize - 10, kSize - 10));
}

TEST(PicturesTest, PairsAreJoinedOnThePartAroundThem) {
  SymmetryRecord record;
  record.samples = {{300.0F, 400.0F}};
  record.mirrored = {{360.0F, 400.0F}};
  const cv::Mat image(kSize, kSize, CV_8UC3, cv::Scalar(0, 0, 0));
  const cv::Mat picture = SymmetryPicture(record, image, "frame 1, object 2");
  // 61 pixels with 24 on both sides are enlarged to the width of a picture.
  const int factor = (kSize + 108) / 109;
  EXPECT_EQ(picture.cols, 109 * factor);
  const int y = static_cast<int>(24.5 * factor);
  EXPECT_EQ(At(picture, static_cast<int>(24.5 * factor), y), cv::Vec3b(66, 228, 240));
  EXPECT_EQ(At(picture, static_cast<int>(84.5 * factor), y), cv::Vec3b(233, 180, 86));
  EXPECT_GT(Brightness(At(picture, static_cast<int>(54.5 * factor), y)), 60) << "the line";
}

TEST(PicturesTest, WithoutPairsTheWholeImageIsShown) {
  const cv::Mat image(kSize, kSize, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat picture = SymmetryPicture({}, image, "");
  EXPECT_EQ(picture.cols, kSize);
  EXPECT_EQ(At(picture, kSize - 1, kSize - 1), cv::Vec3b(1, 2, 3));
}

}  // namespace
}  // namespace soslam
