// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/furniture_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "soslam/geometry/angles.h"
#include "support/coloured_box.h"

namespace soslam {
namespace {

constexpr int kCropSide = 48;

const Eigen::Vector3f kSize = {0.4f, 0.5f, 0.9f};

FurnitureModel RedFront() {
  return TwoColouredBox(kSize, {0.05f, 0.05f, 0.7f}, {0.7f, 0.05f, 0.05f});
}

TEST(RandomView, IsTheSameForTheSameNumbers) {
  const FurnitureModel box = RedFront();
  const auto view = [&](int seed) {
    Random random(seed);
    std::optional<FurnitureView> result;
    while (!result) result = RandomView(box, {&box}, kCropSide, Random(3), &random);
    return *result;
  };
  const FurnitureView one = view(1), same = view(1), other = view(2);
  EXPECT_EQ(one.azimuth, same.azimuth);
  EXPECT_EQ(one.crop.direction.elevation, same.crop.direction.elevation);
  EXPECT_EQ(cv::norm(one.crop.image, same.crop.image, cv::NORM_INF), 0.0);
  EXPECT_NE(one.azimuth, other.azimuth);
  EXPECT_GT(cv::norm(one.crop.image, other.crop.image, cv::NORM_INF), 0.0);
}

// Its colours are others in many views, but no colour is more frequent at the front.
TEST(RandomView, AzimuthIsZeroAtTheFront) {
  const FurnitureModel box = RedFront();
  const FurnitureModel grey = TwoColouredBox(kSize, {0.4f, 0.4f, 0.4f}, {0.4f, 0.4f, 0.4f});
  double redness_at_front = 0.0, redness_at_rear = 0.0;
  int at_front = 0, at_rear = 0;
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const auto view = RandomView(box, {&grey}, kCropSide, Random(i), &random);
    if (!view) continue;
    EXPECT_EQ(view->crop.image.size(), cv::Size(kCropSide, kCropSide));
    EXPECT_NEAR(view->log_ratios.x(), std::log(kSize.x() / kSize.z()), 0.6);
    EXPECT_NEAR(view->log_ratios.y(), std::log(kSize.y() / kSize.z()), 0.6);
    EXPECT_GT(view->crop.direction.elevation, -25.0 * kRadPerDeg);
    EXPECT_LT(view->crop.direction.elevation, 70.0 * kRadPerDeg);
    EXPECT_GE(view->visible_share, 0.4);
    EXPECT_LE(view->visible_share, 1.0);
    constexpr int kQuarter = kCropSide / 4;
    const cv::Scalar mean =
        cv::mean(view->crop.image(cv::Rect(kQuarter, kQuarter, 2 * kQuarter, 2 * kQuarter)));
    if (std::abs(view->azimuth) < 60.0 * kRadPerDeg) {
      redness_at_front += mean[2] - mean[0];
      ++at_front;
    } else if (std::abs(view->azimuth) > 120.0 * kRadPerDeg) {
      redness_at_rear += mean[2] - mean[0];
      ++at_rear;
    }
  }
  ASSERT_GT(at_front, 10);
  ASSERT_GT(at_rear, 10);
  EXPECT_GT(redness_at_front / at_front, 8.0);
  EXPECT_LT(redness_at_rear / at_rear, -8.0);
}

TEST(PlainView, IsFromTheAzimuth) {
  const FurnitureModel box =
      TwoColouredBox(kSize, {0.9f, 0.9f, 0.9f}, {0.1f, 0.1f, 0.1f});  // a bright front
  const auto side_means = [&](double azimuth_deg) {
    const cv::Mat view = PlainView(box, azimuth_deg * kRadPerDeg, 0.3, 64);
    return std::pair(cv::mean(view(cv::Rect(24, 28, 6, 8)))[0],
                     cv::mean(view(cv::Rect(34, 28, 6, 8)))[0]);
  };
  const auto front = side_means(0), rear = side_means(180), left = side_means(90),
             right = side_means(270);
  EXPECT_GT(front.first, 150.0);
  EXPECT_GT(front.second, 150.0);
  EXPECT_LT(rear.first, 60.0);
  EXPECT_LT(rear.second, 60.0);
  EXPECT_GT(left.first, left.second + 80.0);  // from its left, its front is to the left
  EXPECT_LT(right.first, right.second - 80.0);
}

}  // namespace
}  // namespace soslam
