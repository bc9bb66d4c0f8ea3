// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/object_evidence.h"
#include "support/random.h"

namespace soslam {
namespace {

std::vector<double> WeightsOnCircle(const std::vector<double>& angles, double correlation_rad) {
  std::vector<Eigen::Vector3d> directions;
  for (const double angle : angles) {
    directions.push_back(RandomUniform(1.0, 5.0) *
                         Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  return DirectionWeights(directions, correlation_rad);
}

// Weights as defined in the header. Two of the directions are opposite to each other.
TEST(DirectionWeights, OfAllAnglesAreThoseOfTheDefinition) {
  std::vector<double> angles = {0.4, 0.4 + std::numbers::pi};
  for (int i = 0; i < 9; ++i) angles.push_back(RandomUniform(0.0, 2.0 * std::numbers::pi));
  for (const double correlation : {10 * kRadPerDeg, 60 * kRadPerDeg, 180 * kRadPerDeg}) {
    const std::vector<double> weights = WeightsOnCircle(angles, correlation);
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

TEST(DirectionWeights, OnlyTheSameDirectionsShareWithHardlyAnyCorrelation) {
  EXPECT_EQ(WeightsOnCircle({0.7, 0.7, 0.8}, 0.0), std::vector<double>(3, 1.0));
  const Eigen::Vector3d one(0.7, 0.6, 0.0), other(0.8, 0.5, 0.0);
  EXPECT_EQ(DirectionWeights({one, one, other}, 1e-200), (std::vector<double>{0.5, 0.5, 1.0}));
}

// More frames along the same way do not say more.
TEST(DirectionWeights, TheSumDoesNotGrowWithTheFrameRate) {
  const auto sum = [](int frames) {
    std::vector<double> angles;
    for (int i = 0; i < frames; ++i) angles.push_back(0.8 * i / (frames - 1));
    const auto weights = WeightsOnCircle(angles, 15 * kRadPerDeg);
    return std::accumulate(weights.begin(), weights.end(), 0.0);
  };
  EXPECT_NEAR(sum(400), sum(40), 0.05 * sum(400));
  EXPECT_GT(sum(40), 1.0);
}

}  // namespace
}  // namespace soslam
