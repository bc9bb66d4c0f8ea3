// SPDX-License-Identifier: BSD-3-Clause
// Boxes of which an edge is a bound: a nearer object or the image border cuts it off.
#include <gtest/gtest.h>

#include <array>

#include "initialisation/closed_form.h"
#include "initialisation/yaw_sweep.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// Moves one edge outwards (inwards where negative) by a fraction of the box.
Box WithEdgeMoved(Box box, size_t edge, double fraction) {
  double* sides[] = {&box.x_min, &box.y_min, &box.x_max, &box.y_max};
  const double side = edge % 2 == 0 ? box.Width() : box.Height();
  *sides[edge] += (edge < 2 ? -1.0 : 1.0) * fraction * side;
  return box;
}

TEST(SolveAtYaw, RecoversABodyThatABoundCutsFromTheOtherThreeEdges) {
  for (const double p : kShapeExponents) {
    for (size_t edge = 0; edge < 4; ++edge) {
      for (int i = 0; i < 10; ++i) {
        const StandingBody body(p);
        const Box cut = WithEdgeMoved(body.box, edge, -RandomUniform(0.05, 0.3));
        std::array<bool, 4> is_bound{};
        is_bound[edge] = true;
        const auto landmark = SolveAtYaw(body.Observe(cut, is_bound), body.Yaw());
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
      const StandingBody body(RandomUniform(1, 2));
      const Box wide = WithEdgeMoved(body.box, edge, RandomUniform(0.05, 0.2));
      std::array<bool, 4> is_bound{};
      is_bound[edge] = true;
      const auto as_bound = SolveAtYaw(body.Observe(wide, is_bound), body.Yaw());
      const auto as_measured = SolveAtYaw(body.Observe(wide), body.Yaw());
      ASSERT_TRUE(as_bound && as_measured);
      EXPECT_TRUE(IsSameBody(*as_bound, *as_measured, 1e-9)) << "edge " << edge;
      EXPECT_FALSE(IsSameBody(*as_bound, body.truth, 1e-3)) << "edge " << edge;
    }
  }
}

}  // namespace
}  // namespace soslam
