// SPDX-License-Identifier: BSD-3-Clause
#include "planes/plane_heights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace soslam {
namespace {

using testing::ElementsAre;

constexpr double kMaxTilt = 0.1;
constexpr double kNewLevel = 10.0;

// An object with its foot at (x, y) from the pivot on the plane z = height + slope . (x, y), its
// height known to sigma and its tilt not at all. A motion of the plane raises it at the foot by
// turn_x y - turn_y x + rise.
PlaneEvidence FootAt(double x, double y, double sigma) {
  const Eigen::Vector3d d_motion(y, -x, 1.0);
  PlaneEvidence evidence;
  evidence.information = d_motion * d_motion.transpose() / (sigma * sigma);
  return evidence;
}

TEST(ClusterPlaneHeights, GroupsHeightsByTheirUncertainty) {
  const auto levels_of = [](double sigma) {
    const std::vector<PlaneEvidence> evidence(4, FootAt(0, 0, sigma));
    return ClusterPlaneHeights(evidence, {0.51, 0.0, 0.50, 0.01}, {}, kMaxTilt, kNewLevel);
  };
  const PlaneHeights sure = levels_of(0.02);
  EXPECT_THAT(sure.level_of, ElementsAre(1, 0, 1, 0));
  ASSERT_EQ(sure.heights.size(), 2u);
  EXPECT_NEAR(sure.heights[0], 0.005, 1e-9);
  EXPECT_NEAR(sure.heights[1], 0.505, 1e-9);
  EXPECT_THAT(levels_of(0.5).level_of, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(levels_of(0.0001).level_of, ElementsAre(3, 0, 2, 1));
}

// One level for two objects costs 0.5 * (0.2 / (sqrt(2) sigma))^2 more than two levels.
TEST(ClusterPlaneHeights, OpensALevelWhereItIsWorthItsCost) {
  const double sigma = 0.2 / (std::sqrt(2.0) * std::sqrt(2.0 * kNewLevel));
  const auto count = [&](double factor) {
    const std::vector<PlaneEvidence> evidence(2, FootAt(0, 0, factor * sigma));
    return ClusterPlaneHeights(evidence, {0.0, 0.2}, {}, kMaxTilt, kNewLevel).heights.size();
  };
  EXPECT_EQ(count(1.01), 1u);
  EXPECT_EQ(count(0.99), 2u);
}

// Heights at the pivot of objects far apart differ as the tilt is wrong: with the right one they
// agree. Steps of the grid are max_tilt / 32.
TEST(ClusterPlaneHeights, FindsTheTiltInWhichFewLevelsDo) {
  const Eigen::Vector2d tilt(0.05, -0.025);
  const std::vector<Eigen::Vector2d> feet = {{2, 0}, {-2, 1}, {0, 3}, {1, -2}, {-1, -1}};
  std::vector<PlaneEvidence> evidence;
  std::vector<double> heights;
  for (const Eigen::Vector2d& foot : feet) {
    evidence.push_back(FootAt(foot.x(), foot.y(), 0.01));
    heights.push_back(tilt.x() * foot.y() - tilt.y() * foot.x());
  }
  heights[4] += 0.4;
  const PlaneHeights levels = ClusterPlaneHeights(evidence, heights, {}, kMaxTilt, kNewLevel);
  EXPECT_LT((levels.tilt - tilt).norm(), kMaxTilt / 32);
  EXPECT_THAT(levels.level_of, ElementsAre(0, 0, 0, 0, 1));
  EXPECT_NEAR(levels.heights[1] - levels.heights[0], 0.4, 0.02);
}

TEST(ClusterPlaneHeights, HoldsTheTiltToItsPrior) {
  PlaneEvidence prior;
  prior.information.diagonal() << 1e6, 1e6, 0.0;
  const Eigen::Vector2d expected(0.05, 0.0);
  prior.gradient.head<2>() = -1e6 * expected;
  const PlaneHeights levels =
      ClusterPlaneHeights({FootAt(1, 2, 0.01)}, {0.3}, prior, kMaxTilt, kNewLevel);
  EXPECT_LT((levels.tilt - expected).norm(), kMaxTilt / 32);
}

// The partition against all others: numbers of levels are few enough to try.
TEST(ClusterPlaneHeights, NoOtherGroupingCostsLess) {
  for (int trial = 0; trial < 20; ++trial) {
    constexpr size_t kObjects = 5;
    std::vector<PlaneEvidence> evidence;
    std::vector<double> heights, weights;
    for (size_t i = 0; i < kObjects; ++i) {
      const double sigma = RandomUniform(0.02, 0.2);
      evidence.push_back(FootAt(0, 0, sigma));
      heights.push_back(RandomUniform(0, 1));
      weights.push_back(1.0 / (sigma * sigma));
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (int code = 0; code < 3125; ++code) {  // 5^5 labellings
      std::array<double, kObjects> weight{}, first{}, second{};
      int rest = code;
      for (size_t i = 0; i < kObjects; ++i, rest /= 5) {
        const auto level = static_cast<size_t>(rest % 5);
        weight[level] += weights[i];
        first[level] += weights[i] * heights[i];
        second[level] += weights[i] * heights[i] * heights[i];
      }
      double cost = 0.0;
      for (size_t level = 0; level < kObjects; ++level) {
        if (weight[level] == 0.0) continue;
        cost += kNewLevel + 0.5 * (second[level] - first[level] * first[level] / weight[level]);
      }
      lowest = std::min(lowest, cost);
    }
    EXPECT_NEAR(ClusterPlaneHeights(evidence, heights, {}, kMaxTilt, kNewLevel).cost, lowest, 1e-6);
  }
}

// A body that may float by sigma says as much about the plane's height as the variances together.
TEST(WithHeightNoise, AddsTheVariances) {
  PlaneEvidence evidence = FootAt(1.0, 2.0, 0.03);
  evidence.cost = 7.0;
  evidence.gradient = evidence.information.col(2) * 0.01;
  const PlaneEvidence loose = WithHeightNoise(evidence, 0.04);
  EXPECT_LT((loose.information - FootAt(1.0, 2.0, 0.05).information).norm(), 1e-9);
  // The plane is 0.01 m from where the body would have it, at either looseness.
  EXPECT_LT((loose.gradient - loose.information.col(2) * 0.01).norm(), 1e-9);
  EXPECT_NEAR(evidence.cost - loose.cost,
              0.5 * 0.01 * 0.01 * (1.0 / (0.03 * 0.03) - 1.0 / (0.05 * 0.05)), 1e-9);
  EXPECT_EQ(WithHeightNoise(evidence, 0.0).information, evidence.information);
}

}  // namespace
}  // namespace soslam
