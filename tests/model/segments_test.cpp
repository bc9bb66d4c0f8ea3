// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/segments.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

// One frame per angle (rad) by which its camera is turned about the world's x axis; at 0 it looks
// along z, and at -pi/2 along y, with z up.
Sequence CamerasTurnedAboutX(const std::vector<double>& angles) {
  Sequence sequence;
  for (const double angle : angles) {
    Frame frame;
    frame.world_from_camera.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX());
    sequence.frames.push_back(frame);
  }
  return sequence;
}

TEST(UpOfSegment, IsTheMeanOfTheImages) {
  constexpr double kLevel = -0.5 * std::numbers::pi;
  const Sequence sequence = CamerasTurnedAboutX({kLevel + 0.7, kLevel + 0.1, kLevel - 0.2});
  const double mean = 0.2;
  EXPECT_NEAR(UpOfSegment(sequence, 0).z(), std::cos(mean), 0.01);
}

// The sum of their upright directions is no longer than that of random ones.
TEST(UpOfSegment, IsZOfCamerasThatLookInAllDirections) {
  constexpr int kAround = 24;
  std::vector<double> angles = {0.0, 0.0};
  for (int i = 0; i < kAround; ++i) angles.push_back(2.0 * std::numbers::pi * i / kAround);
  EXPECT_EQ(UpOfSegment(CamerasTurnedAboutX(angles), 0), Eigen::Vector3d::UnitZ());
}

// A camera that circles above a table and looks down steeply, in a world whose z is not up: the
// upright directions of its images differ by up to 160 degrees, and their sum still points up.
TEST(UpOfSegment, IsThatOfCamerasThatLookDownSteeply) {
  constexpr int kAround = 60;
  const double down = 80.0 * kRadPerDeg;
  const Eigen::Quaterniond world_from_upright(
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  Sequence sequence;
  for (int i = 0; i < kAround; ++i) {
    Frame frame;
    frame.world_from_camera.rotation =
        world_from_upright *
        Eigen::AngleAxisd(2.0 * std::numbers::pi * i / kAround, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(-0.5 * std::numbers::pi - down, Eigen::Vector3d::UnitX());
    sequence.frames.push_back(frame);
  }
  EXPECT_LT((UpOfSegment(sequence, 0) - world_from_upright * Eigen::Vector3d::UnitZ()).norm(),
            1e-9);
}

}  // namespace
}  // namespace soslam
