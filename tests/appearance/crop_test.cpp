// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/rigid3.h"
#include "support/looking_at.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kSide = 96;
constexpr double kMarginOfCrops = 1.2;

Rigid3d Rolled(const Rigid3d& world_from_camera, double roll) {
  Rigid3d rolled = world_from_camera;
  rolled.rotation = rolled.rotation * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ());
  return rolled;
}

Eigen::Vector3d UpIn(const Rigid3d& world_from_camera) {
  return world_from_camera.rotation.conjugate() * Eigen::Vector3d::UnitZ();
}

// A smooth pattern over the directions of the world, as a camera sees it.
cv::Mat Panorama(const Camera& camera, const Rigid3d& world_from_camera) {
  cv::Mat image(camera.height, camera.width, CV_8UC3);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const Eigen::Vector3d d =
          (world_from_camera.rotation * camera.Ray(Eigen::Vector2d(u, v))).normalized();
      for (int c = 0; c < 3; ++c) {
        const double phase = 9.0 * d[c] + 6.0 * d[(c + 1) % 3];
        image.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<uchar>(128.0 + 90.0 * std::sin(phase));
      }
    }
  }
  return image;
}

// The box of the cone of this half angle (rad) about a direction of the world.
Box BoxOfCone(const Camera& camera, const Rigid3d& world_from_camera, const Eigen::Vector3d& axis,
              double half_angle) {
  const Eigen::Vector3d side = axis.unitOrthogonal();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{kFar, kFar, -kFar, -kFar};
  for (int i = 0; i < 720; ++i) {
    const Eigen::Vector3d edge = Eigen::AngleAxisd(std::numbers::pi * i / 360.0, axis) *
                                 (std::cos(half_angle) * axis + std::sin(half_angle) * side);
    const Eigen::Vector2d pixel = *camera.Project(world_from_camera.rotation.conjugate() * edge);
    box = {std::min(box.x_min, pixel.x()), std::min(box.y_min, pixel.y()),
           std::max(box.x_max, pixel.x()), std::max(box.y_max, pixel.y())};
  }
  return box;
}

TEST(RenderCrop, IsTheEnlargedBoxInTheMiddleOfALevelImage) {
  const Camera camera{640, 480, 500.0, 500.0, 319.5, 239.5};
  cv::Mat image(480, 640, CV_8UC3);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      image.at<cv::Vec3b>(v, u) = {static_cast<uchar>(u - 200), static_cast<uchar>(v - 100), 7};
    }
  }
  for (const Eigen::Vector2d& half : {Eigen::Vector2d(60, 40), Eigen::Vector2d(35, 70)}) {
    const Box box{319.5 - half.x(), 239.5 - half.y(), 319.5 + half.x(), 239.5 + half.y()};
    const Crop crop = RenderCrop(image, camera, box, -Eigen::Vector3d::UnitY(), kSide);
    const double pixel = kMarginOfCrops * 2.0 * half.maxCoeff() / kSide;
    for (const int y : {5, 40, 90}) {
      for (const int x : {5, 48, 90}) {
        const cv::Vec3b seen = crop.image.at<cv::Vec3b>(y, x);
        EXPECT_NEAR(seen[0], 119.5 + pixel * (x - 47.5), 1.6);
        EXPECT_NEAR(seen[1], 139.5 + pixel * (y - 47.5), 1.6);
        EXPECT_EQ(seen[2], 7);
      }
    }
    EXPECT_NEAR(crop.direction.log_aspect, std::log(half.x() / half.y()), 1e-9);
    EXPECT_NEAR(crop.direction.elevation, 0.0, 1e-9);
    EXPECT_LT((crop.direction.ray_in_camera - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
}

TEST(RenderCrop, HasTheMiddleOfTheBoxInItsMiddle) {
  const Camera camera = TestCamera();
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d centre(std::round(RandomUniform(100, 540)),
                                 std::round(RandomUniform(100, 380)));
    const Eigen::Vector2d half(RandomUniform(20, 90), RandomUniform(20, 90));
    cv::Mat image(480, 640, CV_8UC3, cv::Scalar::all(0));
    const cv::Point middle(static_cast<int>(centre.x()), static_cast<int>(centre.y()));
    image(cv::Rect(middle - cv::Point(2, 2), cv::Size(5, 5))) = cv::Scalar::all(255);
    const Box box{centre.x() - half.x(), centre.y() - half.y(), centre.x() + half.x(),
                  centre.y() + half.y()};
    const Rigid3d pose =
        Rolled(LookingAt({0, 0, 1.5}, {3, 0, RandomUniform(-1, 2)}), RandomUniform(-3, 3));
    const Crop crop = RenderCrop(image, camera, box, UpIn(pose), kSide);
    cv::Mat grey;
    cv::extractChannel(crop.image, grey, 0);
    cv::Point brightest;
    cv::minMaxLoc(grey, nullptr, nullptr, nullptr, &brightest);
    EXPECT_NEAR(brightest.x, 47.5, 0.05 * kSide);
    EXPECT_NEAR(brightest.y, 47.5, 0.05 * kSide);
  }
}

TEST(RenderCrop, IsTheSameHoweverTheCameraIsRolled) {
  const Camera camera{640, 640, 520.0, 530.0, 318.0, 322.0};
  const Rigid3d level = LookingAt({0, 0, 1.5}, {3, 0.2, 0.6});
  const Eigen::Vector3d axis = Eigen::Vector3d(3, 0.5, -1.0).normalized();
  const auto crop_at = [&](double roll) {
    const Rigid3d pose = Rolled(level, roll);
    return RenderCrop(Panorama(camera, pose), camera, BoxOfCone(camera, pose, axis, 0.12),
                      UpIn(pose), kSide);
  };
  const Crop upright = crop_at(0.0);
  for (const double roll : {0.2, -0.7, 0.8, 1.5708, 2.5, 3.1416}) {
    const Crop crop = crop_at(roll);
    EXPECT_LT(cv::norm(crop.image, upright.image, cv::NORM_L1) / (3.0 * kSide * kSide), 2.5)
        << roll;
    EXPECT_NEAR(crop.direction.elevation, upright.direction.elevation, 0.005);
    EXPECT_NEAR(crop.direction.log_aspect, upright.direction.log_aspect, 0.03);
  }
}

TEST(RenderCrop, ElevationIsPositiveFromAbove) {
  for (const double height : {2.5, 0.4, -1.0}) {
    const Eigen::Vector3d position(-2.0, 0.5, height), target(1.0, -0.2, 0.4);
    const Rigid3d pose = LookingAt(position, target);
    const Box box{300, 220, 336, 264};  // about the principal point
    const Crop crop = RenderCrop(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(0)), TestCamera(), box,
                                 UpIn(pose), kSide);
    EXPECT_NEAR(crop.direction.elevation, std::asin((height - 0.4) / (position - target).norm()),
                1e-9);
  }
}

TEST(RenderCrop, WhatLiesOutsideTheImageIsGrey) {
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar::all(250));
  const Box box{-60, 200, 60, 300};  // half of it left of the image
  const Crop crop = RenderCrop(image, TestCamera(), box, -Eigen::Vector3d::UnitY(), kSide);
  EXPECT_EQ(crop.image.size(), cv::Size(kSide, kSide));
  EXPECT_EQ(crop.image.at<cv::Vec3b>(48, 5), cv::Vec3b::all(114));
  EXPECT_EQ(crop.image.at<cv::Vec3b>(48, 90), cv::Vec3b::all(250));
}

TEST(RenderCrop, LooksStraightDownToo) {
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar::all(250));
  const Crop crop =
      RenderCrop(image, TestCamera(), {308, 232, 328, 252}, -Eigen::Vector3d::UnitZ(), kSide);
  EXPECT_NEAR(crop.direction.elevation, std::numbers::pi / 2.0, 1e-6);
  EXPECT_EQ(crop.image.at<cv::Vec3b>(48, 48), cv::Vec3b::all(250));
}

// A pattern as fine as pixels, of which a small crop has the mean.
TEST(RenderCrop, DoesNotAlias) {
  cv::Mat image(480, 640, CV_8UC3);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      image.at<cv::Vec3b>(v, u) = cv::Vec3b::all((u + v) % 2 == 0 ? 200 : 100);
    }
  }
  const Crop crop =
      RenderCrop(image, TestCamera(), {168, 92, 468, 392}, -Eigen::Vector3d::UnitY(), 64);
  cv::Scalar mean, deviation;
  cv::meanStdDev(crop.image, mean, deviation);
  EXPECT_NEAR(mean[0], 150.0, 2.0);
  EXPECT_LT(deviation[0], 3.0);
}

}  // namespace
}  // namespace soslam
