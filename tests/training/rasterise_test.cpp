// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/rasterise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/coloured_box.h"
#include "support/looking_at.h"

namespace soslam {
namespace {

const Camera kPinhole = {320, 240, 200.0, 210.0, 159.5, 119.5};
// Everything is as bright as its own colour.
const Lighting kAmbient = {{}, Eigen::Vector3f::Ones(), Eigen::Vector3f::Ones()};

FurnitureModel RedBox() { return TwoColouredBox({1.0f, 2.0f, 0.8f}, {0, 0, 1}, {0, 0, 1}); }

PlacedModel At(const FurnitureModel& model, float x) {
  return {&model, Eigen::Affine3f(Eigen::Translation3f(x, 0.0f, 0.0f)), model.materials};
}

// From the front of the box, at the height of its middle.
Rasteriser CanvasAlong(double distance) {
  return {kPinhole, LookingAt({distance, 0.0, 0.4}, {0.0, 0.0, 0.4}).Inverse()};
}

TEST(Rasteriser, ABoxHasItsDepthAndOutline) {
  const FurnitureModel box = RedBox();
  Rasteriser canvas = CanvasAlong(4.5);
  canvas.Draw(At(box, 0.0f), kAmbient, 7);
  const double depth = 4.0;  // of the face that it shows
  EXPECT_NEAR(canvas.inverse_depth.at<float>(120, 160), 1.0 / depth, 1e-5);
  EXPECT_NEAR(canvas.inverse_depth.at<float>(125, 190), 1.0 / depth, 1e-5);
  EXPECT_EQ(canvas.inverse_depth.at<float>(3, 3), 0.0f);
  EXPECT_EQ(canvas.number.at<uchar>(120, 160), 7);
  EXPECT_EQ(canvas.number.at<uchar>(3, 3), 0);
  EXPECT_NEAR(canvas.colour.at<cv::Vec3f>(120, 160)[2], 255.0f, 1e-3f);
  EXPECT_NEAR(canvas.colour.at<cv::Vec3f>(120, 160)[0], 0.0f, 1e-3f);
  const cv::Rect outline = cv::boundingRect(canvas.number == 7);
  EXPECT_NEAR(outline.width, 200.0 * 2.0 / depth, 1.0);
  EXPECT_NEAR(outline.height, 210.0 * 0.8 / depth, 1.0);
  EXPECT_NEAR(outline.x + 0.5 * (outline.width - 1), kPinhole.cx, 0.6);
  EXPECT_NEAR(outline.y + 0.5 * (outline.height - 1), kPinhole.cy, 0.6);
  EXPECT_EQ(cv::countNonZero(canvas.number == 7), outline.area());  // no gap between triangles
}

// The top of a box, where depth and texture are not linear in the image.
TEST(Rasteriser, DepthIsThatOfThePlaneAlongEachRay) {
  const FurnitureModel box = RedBox();
  Rasteriser canvas(kPinhole, LookingAt({3.0, 0.7, 2.5}, {0.0, 0.0, 0.8}).Inverse());
  canvas.Draw(At(box, 0.0f), kAmbient, 1);
  int on_top = 0;
  for (int v = 0; v < kPinhole.height; v += 3) {
    for (int u = 0; u < kPinhole.width; u += 3) {
      const Eigen::Vector3f ray = canvas.RayInWorld(u, v), centre = canvas.CentreInWorld();
      const float depth = (0.8f - centre.z()) / ray.z();  // along a ray with z = 1 in the camera
      const Eigen::Vector3f point = centre + depth * ray;
      if (std::abs(point.x()) > 0.48f || std::abs(point.y()) > 0.98f) continue;
      EXPECT_NEAR(canvas.inverse_depth.at<float>(v, u), 1.0f / depth, 1e-4f);
      ++on_top;
    }
  }
  EXPECT_GT(on_top, 100);
}

TEST(Rasteriser, TheNearerModelHidesTheOther) {
  const FurnitureModel box = RedBox();
  for (const bool is_nearer_first : {true, false}) {
    Rasteriser canvas = CanvasAlong(6.0);
    if (is_nearer_first) canvas.Draw(At(box, 2.0f), kAmbient, 2);
    canvas.Draw(At(box, 0.0f), kAmbient, 1);
    if (!is_nearer_first) canvas.Draw(At(box, 2.0f), kAmbient, 2);
    EXPECT_EQ(canvas.number.at<uchar>(120, 160), 2);
    EXPECT_EQ(cv::countNonZero(canvas.number == 1), 0);  // it is all behind
    EXPECT_NEAR(canvas.inverse_depth.at<float>(120, 160), 1.0f / 3.5f, 1e-5f);
  }
}

TEST(Rasteriser, LightIsBrightestAlongTheNormal) {
  const FurnitureModel box = RedBox();
  const auto brightness = [&](const Eigen::Vector3f& towards) {
    Rasteriser canvas = CanvasAlong(4.5);
    const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
    canvas.Draw(At(box, 0.0f), {{{towards, Eigen::Vector3f::Ones()}}, zero, zero}, 1);
    return canvas.colour.at<cv::Vec3f>(120, 160)[2];
  };
  EXPECT_NEAR(brightness(Eigen::Vector3f::UnitX()), 255.0f, 0.1f);
  EXPECT_NEAR(brightness({0.6f, 0.8f, 0.0f}), 0.6f * 255.0f, 0.1f);
  EXPECT_NEAR(brightness(-Eigen::Vector3f::UnitX()), 0.0f, 0.1f);
}

TEST(Rasteriser, ShadowsLieOnTheFloorAwayFromTheLight) {
  const FurnitureModel box = RedBox();
  Rasteriser canvas(kPinhole, LookingAt({0.01, 0.0, 8.0}, {0.0, 0.0, 0.0}).Inverse());
  cv::Mat mask(kPinhole.height, kPinhole.width, CV_8U, cv::Scalar(0));
  canvas.DrawShadow(At(box, 0.0f), Eigen::Vector3f(0.6f, 0.0f, 0.8f), &mask);
  // From x = -0.5 - 0.8 * 0.6 / 0.8 to 0.5.
  int lit = 0;
  for (int v = 0; v < kPinhole.height; v += 2) {
    const Eigen::Vector3f ray = canvas.RayInWorld(160, v);
    const Eigen::Vector3f centre = canvas.CentreInWorld();
    const float x = centre.x() - centre.z() / ray.z() * ray.x();
    if (std::abs(x - 0.5f) < 0.06f || std::abs(x + 1.1f) < 0.06f) continue;
    EXPECT_EQ(mask.at<uchar>(v, 160) == 255, x < 0.5f && x > -1.1f) << x;
    ++lit;
  }
  EXPECT_GT(lit, 50);
}

TEST(Rasteriser, WhatReachesBehindTheCameraIsLeftOut) {
  const FurnitureModel box = RedBox();
  Rasteriser canvas = CanvasAlong(0.2);
  canvas.Draw(At(box, 0.0f), kAmbient, 1);
  canvas.Draw(At(box, 9.0f), kAmbient, 1);
  EXPECT_LE(cv::countNonZero(canvas.number), kPinhole.width * kPinhole.height);
}

}  // namespace
}  // namespace soslam
