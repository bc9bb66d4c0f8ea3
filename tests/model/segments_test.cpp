// SPDX-License-Identifier: BSD-3-Clause
#include "model/segments.h"

#include <gtest/gtest.h>

#include <numbers>

namespace soslam {
namespace {

// One frame per angle (rad) by which its camera is turned about the world's x axis; at 0 it looks
// down.
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

// However many there are, what they have in common does not count.
TEST(UpOfSegment, IsZOfCamerasThatLookInAllDirections) {
  constexpr int kAround = 24;
  std::vector<double> angles = {0.0, 0.0};
  for (int i = 0; i < kAround; ++i) angles.push_back(2.0 * std::numbers::pi * i / kAround);
  EXPECT_EQ(UpOfSegment(CamerasTurnedAboutX(angles), 0), Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace soslam
