// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/body_at_yaw.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

TEST(SolveAtYaw, RecoversTheBodyOfAnExactBoxAtItsYaw) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 50; ++i) {
      const ObservedBody body(p);
      const auto landmark = SolveAtYaw(body.evidence, body.Yaw());
      ASSERT_TRUE(landmark) << p;
      EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-8)) << p;
    }
  }
}

TEST(SolveAtYaw, StandsOnThePlaneAtTheYaw) {
  for (int i = 0; i < 100; ++i) {
    const ObservedBody body(RandomUniform(1, 2));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(body.Observe(Disturbed(body.box, 0.05)), yaw);
    ASSERT_TRUE(landmark);
    EXPECT_NEAR(std::remainder(Yaw(body.plane.normal, landmark->frame_from_object.rotation) - yaw,
                               2.0 * std::numbers::pi),
                0.0, 1e-9);
    EXPECT_NEAR(body.plane.SignedDistance(landmark->Centre()), landmark->half_axes.z(), 1e-9);
    EXPECT_EQ(landmark->shape_exponents, body.truth.shape_exponents);
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
    const auto landmark = SolveAtYaw(EvidenceOfBox(box, {}, RandomFloor(), prior), RandomYaw());
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
    const ObservedBody body(RandomUniform(1, 2));
    ObjectEvidence evidence = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(evidence, yaw);
    const double scale = RandomUniform(0.1, 10.0);
    evidence.plane.offset *= scale;
    const auto scaled = SolveAtYaw(evidence, yaw);
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
    const ObservedBody body(RandomUniform(1, 2));
    ObjectEvidence evidence = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(evidence, yaw);
    const auto half_turn = SolveAtYaw(evidence, yaw + std::numbers::pi);
    std::swap(evidence.prior->ratio.x(), evidence.prior->ratio.y());
    const auto quarter_turn = SolveAtYaw(evidence, yaw + 0.5 * std::numbers::pi);
    ASSERT_TRUE(landmark && half_turn && quarter_turn);
    EXPECT_TRUE(IsSameBody(*half_turn, *landmark, 1e-9));
    Landmark exchanged = RotatedAboutZ(*landmark, 0.5 * std::numbers::pi);
    std::swap(exchanged.half_axes.x(), exchanged.half_axes.y());
    EXPECT_TRUE(IsSameBody(*quarter_turn, exchanged, 1e-9));
  }
}

// Moves one edge outwards (inwards where negative) by a fraction of the box.
Box WithEdgeMoved(Box box, size_t edge, double fraction) {
  double* sides[] = {&box.x_min, &box.y_min, &box.x_max, &box.y_max};
  const double side = edge % 2 == 0 ? box.Width() : box.Height();
  *sides[edge] += (edge < 2 ? -1.0 : 1.0) * fraction * side;
  return box;
}

// Boxes of which an edge is a bound: a nearer object or the image border cuts it off.

TEST(SolveAtYaw, RecoversABodyThatABoundCutsFromTheOtherThreeEdges) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (size_t edge = 0; edge < 4; ++edge) {
      for (int i = 0; i < 10; ++i) {
        const ObservedBody body(p);
        const Box cut = WithEdgeMoved(body.box, edge, -RandomUniform(0.05, 0.3));
        std::array<bool, 4> is_one_sided{};
        is_one_sided[edge] = true;
        const auto landmark = SolveAtYaw(body.Observe(cut, is_one_sided), body.Yaw());
        ASSERT_TRUE(landmark) << "edge " << edge;
        EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-6)) << "edge " << edge;
        // Used as a measurement, the same edge changes the object.
        const auto measured = SolveAtYaw(body.Observe(cut), body.Yaw());
        EXPECT_FALSE(measured && IsSameBody(*measured, body.truth, 1e-3)) << "edge " << edge;
      }
    }
  }
}

// The object reaches below where a nearer one hides it, the horizon or higher, while its other
// edges show its size and place.
TEST(SolveAtYaw, RecoversABodyThatIsHiddenUpToTheHorizon) {
  const Plane floor{-Eigen::Vector3d::UnitY(), 1.0};
  const Landmark cabinet = WithShape(
      StandingCuboid(TestCamera(), floor, {300, 390}, 0.4, {0.4, 0.3, 0.9}), kCuboidExponent);
  Box visible = *OutlineBox(TestCamera(), cabinet);
  const double horizon_px = TestCamera().cy;
  ASSERT_LT(visible.y_min, horizon_px - 50.0);
  for (const double lower_edge_px : {horizon_px + 20.0, horizon_px - 20.0}) {
    visible.y_max = lower_edge_px;
    const auto landmark = SolveAtYaw(
        EvidenceOfBox(visible, {false, false, false, true}, floor, PriorOf(cabinet, 0.05)), 0.4);
    ASSERT_TRUE(landmark) << "lower edge " << lower_edge_px << ", horizon " << horizon_px;
    EXPECT_TRUE(IsSameBody(*landmark, cabinet, 1e-6));
  }
}

TEST(SolveAtYaw, HoldsABoundThatTheBodyDoesNotReachForMeasured) {
  for (size_t edge = 0; edge < 4; ++edge) {
    for (int i = 0; i < 20; ++i) {
      const ObservedBody body(RandomUniform(1, 2));
      const Box wide = WithEdgeMoved(body.box, edge, RandomUniform(0.05, 0.2));
      std::array<bool, 4> is_one_sided{};
      is_one_sided[edge] = true;
      const auto as_bound = SolveAtYaw(body.Observe(wide, is_one_sided), body.Yaw());
      const auto as_measured = SolveAtYaw(body.Observe(wide), body.Yaw());
      ASSERT_TRUE(as_bound && as_measured);
      EXPECT_TRUE(IsSameBody(*as_bound, *as_measured, 1e-9)) << "edge " << edge;
      EXPECT_FALSE(IsSameBody(*as_bound, body.truth, 1e-3)) << "edge " << edge;
    }
  }
}

}  // namespace
}  // namespace soslam
