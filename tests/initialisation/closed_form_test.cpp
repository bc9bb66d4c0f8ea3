// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

TEST(ClosedForm, IsTheSameToTheLastBitWhateverTheOtherYaws) {
  int mixed = 0;  // of bodies that are in front of the camera at some yaws only
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector4d sides =
          Eigen::Vector4d::NullaryExpr([] { return RandomUniform(1, 500); });
      const Box box{300.0 - sides(0), 300.0 - sides(1), 300.0 + sides(2), 300.0 + sides(3)};
      const ShapePrior prior{{std::exp(RandomUniform(-4, 4)), 1.0}, {1, 1}, p};
      const ClosedForm closed_form(ObservationOf(box, {i % 3 == 0}, RandomFloor(), prior));
      std::vector<double> yaws(static_cast<size_t>(2 + i % 7));
      for (double& yaw : yaws) yaw = RandomYaw();
      const auto together = closed_form.At(yaws);
      ASSERT_EQ(together.size(), yaws.size());
      size_t found = 0;
      for (size_t k = 0; k < yaws.size(); ++k) {
        const auto alone = closed_form.At(yaws[k]);
        ASSERT_EQ(together[k].has_value(), alone.has_value());
        if (!alone) continue;
        ++found;
        EXPECT_EQ(together[k]->parameters, alone->parameters);
        EXPECT_TRUE((together[k]->depths_m == alone->depths_m).all());
      }
      mixed += found > 0 && found < yaws.size() ? 1 : 0;
    }
  }
  EXPECT_GT(mixed, 5);
}

TEST(ClosedForm, HasTheDepthsOfItsOwnTangentPoints) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(p);
      const UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
      const auto start = ClosedForm(observation).At(RandomYaw());
      ASSERT_TRUE(start);
      const Landmark landmark = UprightGround(body.plane).LandmarkAt(start->parameters, p);
      for (size_t edge = 0; edge < 4; ++edge) {
        const double depth_m = start->depths_m[static_cast<Eigen::Index>(edge)];
        EXPECT_NEAR(TangentDepth(observation.edges[edge], landmark), depth_m, 1e-8 * depth_m);
      }
    }
  }
}

// A wide box close to the camera. With all tangent points equally deep, the body would reach behind
// the camera; repetition from there would lead to one in front.
TEST(ClosedForm, HasNoneWhereARepetitionIsNotInFront) {
  const Plane floor{Eigen::Vector3d(0.0, -1.0, -0.15).normalized(), 1.2};
  const ShapePrior prior{{5.2, 2.58}, {1.0, 1.0}, kEllipsoidExponent};
  const ClosedForm closed_form(ObservationOf({170, -161, 705, 387}, {}, floor, prior));
  EXPECT_FALSE(closed_form.At(0.2));
}

TEST(ClosedForm, HasNoneOfTwoMeasuredEdges) {
  const StandingBody body(kEllipsoidExponent);
  const ClosedForm closed_form(body.Observe(body.box, {true, false, true, false}));
  EXPECT_FALSE(closed_form.HasEnoughEdges());
  for (const auto& start : closed_form.At({0.0, 0.5, 1.0})) EXPECT_FALSE(start);
  EXPECT_TRUE(closed_form.At(std::vector<double>()).empty());
}

}  // namespace
}  // namespace soslam
