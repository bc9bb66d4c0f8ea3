// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "initialisation/closed_form.h"
#include "initialisation/yaw_sweep.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

TEST(SolveAtYaw, RecoversTheBodyOfAnExactBoxAtItsYaw) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 50; ++i) {
      const StandingBody body(p);
      const auto landmark = SolveAtYaw(body.observation, body.Yaw());
      ASSERT_TRUE(landmark) << p;
      EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-8)) << p;
    }
  }
}

TEST(SolveAtYaw, StandsOnThePlaneAtTheYawWithThePriorsRatio) {
  for (int i = 0; i < 100; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(body.Observe(Disturbed(body.box, 0.05)), yaw);
    ASSERT_TRUE(landmark);
    EXPECT_NEAR(std::remainder(Yaw(body.plane.normal, landmark->frame_from_object.rotation) - yaw,
                               2.0 * std::numbers::pi),
                0.0, 1e-9);
    EXPECT_NEAR(body.plane.SignedDistance(landmark->Centre()), landmark->half_axes.z(), 1e-9);
    const Eigen::Vector2d ratio = landmark->half_axes.head<2>() / landmark->half_axes.z();
    EXPECT_LT((ratio - body.observation.prior.ratio).norm(), 1e-9);
    EXPECT_EQ(landmark->shape_exponent, body.truth.shape_exponent);
  }
}

TEST(SolveAtYaw, HasNoneWhereThePlaneIsNotInView) {
  for (int i = 0; i < 20; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation above = body.observation;
    above.plane_in_camera.offset = -above.plane_in_camera.offset;
    EXPECT_FALSE(SolveAtYaw(above, RandomYaw()));
    UprightObservation behind = body.observation;
    behind.plane_in_camera = {Eigen::Vector3d::UnitZ(), RandomUniform(0.5, 3.0)};
    EXPECT_FALSE(SolveAtYaw(behind, RandomYaw()));
    // All of the box above the horizon of a floor below a level camera.
    UprightObservation sky = body.Observe({300, 50, 350, TestCamera().cy - 10.0});
    sky.plane_in_camera = {-Eigen::Vector3d::UnitY(), 1.0};
    EXPECT_FALSE(SolveAtYaw(sky, RandomYaw()));
  }
}

TEST(SolveAtYaw, HasNoBodyThatIsNotInFrontOfTheCameraForBoxesThatNoneExplains) {
  int none = 0;
  constexpr int kBoxes = 1000;
  for (int i = 0; i < kBoxes; ++i) {
    const Eigen::Vector4d sides =
        Eigen::Vector4d::NullaryExpr([] { return RandomUniform(1, 500); });
    const Box box{300.0 - sides(0), 300.0 - sides(1), 300.0 + sides(2), 300.0 + sides(3)};
    const ShapePrior prior{{std::exp(RandomUniform(-4, 4)), std::exp(RandomUniform(-4, 4))},
                           {1, 1},
                           RandomUniform(1, 2)};
    const auto landmark = SolveAtYaw(ObservationOf(box, {}, RandomFloor(), prior), RandomYaw());
    none += landmark ? 0 : 1;
    if (!landmark) continue;
    EXPECT_TRUE(landmark->Centre().allFinite() && landmark->half_axes.allFinite());
    EXPECT_GT(landmark->half_axes.minCoeff(), 0.0);
    EXPECT_TRUE(IsInFront(*landmark));
  }
  EXPECT_GT(none, kBoxes / 100);
  EXPECT_LT(none, kBoxes / 2);
}

TEST(SolveAtYaw, ScalesWithTheHeightOfTheCamera) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(observation, yaw);
    const double scale = RandomUniform(0.1, 10.0);
    observation.plane_in_camera.offset *= scale;
    const auto scaled = SolveAtYaw(observation, yaw);
    ASSERT_TRUE(landmark && scaled);
    Landmark expected = *landmark;
    expected.half_axes *= scale;
    expected.frame_from_object.translation *= scale;
    EXPECT_TRUE(IsSameBody(*scaled, expected, 1e-9));
  }
}

// Half a turn leaves every body as it is; a quarter turn exchanges a and b.
TEST(SolveAtYaw, IsTheSameBodyAfterAHalfTurnAndAfterAQuarterTurnWithTheAxesExchanged) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(observation, yaw);
    const auto half_turn = SolveAtYaw(observation, yaw + std::numbers::pi);
    std::swap(observation.prior.ratio.x(), observation.prior.ratio.y());
    const auto quarter_turn = SolveAtYaw(observation, yaw + 0.5 * std::numbers::pi);
    ASSERT_TRUE(landmark && half_turn && quarter_turn);
    EXPECT_TRUE(IsSameBody(*half_turn, *landmark, 1e-9));
    EXPECT_TRUE(IsSameBody(*quarter_turn, WithAxesExchanged(*landmark), 1e-9));
  }
}

}  // namespace
}  // namespace soslam
