// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// A wide box close to the camera. With all tangent points equally deep, the body would reach behind
// the camera; repetition from there would lead to one in front.
TEST(ClosedForm, HasNoneWhereARepetitionIsNotInFront) {
  const Plane floor{Eigen::Vector3d(0.0, -1.0, -0.15).normalized(), 1.2};
  const ShapePrior prior{{5.2, 2.58}, {1.0, 1.0}, kEllipsoidExponent};
  const ClosedForm closed_form(ObservationOf({170, -161, 705, 387}, {}, floor, prior));
  EXPECT_FALSE(closed_form.At(0.2));
}

TEST(SolveAtYaw, RecoversTheBodyOfAnExactBoxAtItsYaw) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 50; ++i) {
      const ObservedBody body(p);
      const auto landmark = SolveAtYaw(body.observation, body.Yaw());
      ASSERT_TRUE(landmark) << p;
      EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-8)) << p;
    }
  }
}

TEST(SolveAtYaw, StandsOnThePlaneAtTheYawWithThePriorsRatio) {
  for (int i = 0; i < 100; ++i) {
    const ObservedBody body(RandomUniform(1, 2));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(body.Observe(Disturbed(body.box, 0.05)), yaw);
    ASSERT_TRUE(landmark);
    EXPECT_NEAR(std::remainder(Yaw(body.plane.normal, landmark->frame_from_object.rotation) - yaw,
                               2.0 * std::numbers::pi),
                0.0, 1e-9);
    EXPECT_NEAR(body.plane.SignedDistance(landmark->Centre()), landmark->half_axes.z(), 1e-9);
    const Eigen::Vector2d ratio = landmark->half_axes.head<2>() / landmark->half_axes.z();
    EXPECT_LT((ratio - body.observation.prior.ratio).norm(), 1e-9);
    EXPECT_EQ(landmark->shape_exponents, body.truth.shape_exponents);
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
        ObservationOf(visible, {false, false, false, true}, floor, PriorOf(cabinet, 0.05)), 0.4);
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
