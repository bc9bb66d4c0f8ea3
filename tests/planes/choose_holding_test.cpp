// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planes/camera_holding.h"

namespace soslam {
namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;

HoldingEvidence Evidence(CameraHolding holding, const Eigen::Vector3d& up,
                         std::vector<std::optional<double>> object_costs) {
  HoldingEvidence evidence;
  evidence.holding = holding;
  evidence.up_in_world = up;
  evidence.object_costs = std::move(object_costs);
  return evidence;
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kSide = Eigen::Vector3d::UnitX();

TEST(ChooseHolding, WithoutOtherEvidenceCamerasAreLevel) {
  const HoldingChoice choice = ChooseHolding({Evidence(CameraHolding::kRolled90, kSide, {1.0}),
                                              Evidence(CameraHolding::kLevel, kUp, {1.0})},
                                             10.0);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_NEAR(choice.costs[0], std::log(100.0), 1e-12);
  EXPECT_EQ(choice.costs[1], 0.0);
  EXPECT_NEAR(choice.probabilities[0], 1.0 / 101.0, 1e-12);
}

// One in eleven: far from clear.
TEST(ChooseHolding, TheUncertaintyIsThatOfAllThatMayBeRight) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {1.0, 1.0});
  const auto rolled = Evidence(CameraHolding::kRolled90, kSide, {1.0, 1.0 - std::log(1000.0)});
  const HoldingChoice choice = ChooseHolding({level, rolled}, 10.0);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_NEAR(choice.tilt_variance, kRightAngle * kRightAngle / 11.0, 1e-9);
}

TEST(ChooseHolding, AClearChoiceAddsNoUncertainty) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {0.0, 0.0});
  const auto rolled = Evidence(CameraHolding::kRolled90, kSide, {3.0, 3.0});
  EXPECT_EQ(ChooseHolding({level, rolled}, 10.0).tilt_variance, 0.0);
  EXPECT_GT(ChooseHolding({level, rolled}, 10.0, 1e-9).tilt_variance, 0.0);
}

TEST(ChooseHolding, AnotherWayToTheSameUpIsNoDoubt) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {0.0});
  const Eigen::Vector3d near_up = Eigen::Vector3d(0.05, 0.0, 1.0).normalized();
  const auto down = Evidence(CameraHolding::kLookingDown, near_up, {-4.0});
  const HoldingChoice choice = ChooseHolding({level, down}, 10.0);
  EXPECT_GT(choice.probabilities[1], 0.3);
  EXPECT_EQ(choice.tilt_variance, 0.0);
}

// Its boxes may be of two things: its cost says no more than that.
TEST(ChooseHolding, NoObjectAloneDecides) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {500.0, 0.0, 0.0});
  const auto rolled = Evidence(CameraHolding::kRolled90, kSide, {0.0, 8.0, 8.0});
  EXPECT_EQ(ChooseHolding({level, rolled}, 1e3).best, 0u);
  const auto without_body = Evidence(CameraHolding::kLevel, kUp, {std::nullopt, 0.0, 0.0});
  EXPECT_EQ(ChooseHolding({without_body, rolled}, 1e3).costs,
            ChooseHolding({level, rolled}, 1e3).costs);
}

// Ten times the cost that noise would make: differences count a tenth.
TEST(ChooseHolding, WhereBodiesFitBadlyBoxesSayLess) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {50.0, 50.0});
  const auto rolled = Evidence(CameraHolding::kRolled90, kSide, {60.0, 60.0});
  EXPECT_NEAR(ChooseHolding({level, rolled}, 10.0).costs[1], std::log(100.0) + 2.0, 1e-9);
  EXPECT_NEAR(ChooseHolding({level, rolled}, 1e3).costs[1], std::log(100.0) + 2.0 * std::log(1e4),
              1e-9);
}

TEST(ChooseHolding, ThingsAreSeldomSeenFromBelowTheirPlane) {
  auto level = Evidence(CameraHolding::kLevel, kUp, {1.0});
  auto hung_upside_down = Evidence(CameraHolding::kRolled180, -kUp, {1.0});
  level.share_from_below = 1.0;
  EXPECT_EQ(ChooseHolding({level, hung_upside_down}, 10.0).best, 1u);
  level.share_from_below = 0.3;
  EXPECT_EQ(ChooseHolding({level, hung_upside_down}, 10.0).best, 0u);
}

TEST(ChooseHolding, WhatCannotBeChosenMakesDoubt) {
  const auto level = Evidence(CameraHolding::kLevel, kUp, {1.0, 9.0});
  auto rolled = Evidence(CameraHolding::kRolled90, kSide, {1.0, 1.0});
  rolled.can_be_chosen = false;
  const HoldingChoice choice = ChooseHolding({rolled, level}, 1e3);
  EXPECT_EQ(choice.best, 1u);
  EXPECT_LT(choice.costs[0], 0.0);
  EXPECT_GT(choice.tilt_variance, 1.0);
}

}  // namespace
}  // namespace soslam
