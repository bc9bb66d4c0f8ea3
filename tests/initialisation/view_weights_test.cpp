// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/view_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "geometry/angles.h"
#include "support/random.h"

namespace soslam {
namespace {

// Cameras on a circle around `centre`, at these angles, each with one detection.
struct Circle {
  Circle(const Eigen::Vector3d& centre_in_world, const std::vector<double>& angles)
      : centre(centre_in_world) {
    for (const double angle : angles) {
      Frame frame;
      frame.world_from_camera = {
          RandomRotation(), centre + 3.0 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)};
      Detection detection;
      detection.frame_index = static_cast<int>(sequence.frames.size());
      sequence.frames.push_back(frame);
      detections.push_back(static_cast<int>(sequence.detections.size()));
      sequence.detections.push_back(detection);
    }
  }
  std::vector<double> Weights(double correlation_rad) const {
    return ViewWeights(sequence, detections, centre, correlation_rad);
  }

  Eigen::Vector3d centre;
  Sequence sequence;
  std::vector<int> detections;
};

// Weights as defined in the header. The number of views is not a multiple of four; two of them are
// opposite to each other.
TEST(ViewWeights, OfAllAnglesAreThoseOfTheDefinition) {
  std::vector<double> angles = {0.4, 0.4 + std::numbers::pi};
  for (int i = 0; i < 9; ++i) angles.push_back(RandomUniform(0.0, 2.0 * std::numbers::pi));
  const Circle circle(RandomVector(-2, 2), angles);
  for (const double correlation : {10 * kRadPerDeg, 60 * kRadPerDeg, 180 * kRadPerDeg}) {
    const std::vector<double> weights = circle.Weights(correlation);
    for (size_t i = 0; i < angles.size(); ++i) {
      double similar_views = 0.0;
      for (const double other : angles) {
        const double angle = std::remainder(angles[i] - other, 2.0 * std::numbers::pi);
        similar_views += std::exp(-0.5 * std::pow(angle / correlation, 2));
      }
      EXPECT_NEAR(weights[i], 1.0 / similar_views, 1e-10);
    }
  }
}

TEST(ViewWeights, OnlyTheSameViewsShareWithHardlyAnyCorrelation) {
  const Circle circle({1, 2, 3}, {0.7, 0.7, 0.8});
  EXPECT_EQ(circle.Weights(0.0), std::vector<double>(3, 1.0));
  EXPECT_EQ(circle.Weights(1e-200), (std::vector<double>{0.5, 0.5, 1.0}));
}

// More frames along the same way do not say more.
TEST(ViewWeights, TheSumDoesNotGrowWithTheFrameRate) {
  const auto sum = [](int frames) {
    std::vector<double> angles;
    for (int i = 0; i < frames; ++i) angles.push_back(0.8 * i / (frames - 1));
    const auto weights = Circle({0, 0, 0}, angles).Weights(15 * kRadPerDeg);
    return std::accumulate(weights.begin(), weights.end(), 0.0);
  };
  EXPECT_NEAR(sum(400), sum(40), 0.05 * sum(400));
  EXPECT_GT(sum(40), 1.0);
}

}  // namespace
}  // namespace soslam
