// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <gtest/gtest.h>

#include <cstddef>

#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

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
        EXPECT_NEAR(FindTangentDepth(observation.edges[edge], landmark).depth_m, depth_m,
                    1e-8 * depth_m);
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
  for (const double yaw : {0.0, 0.5, 1.0}) EXPECT_FALSE(closed_form.At(yaw));
}

}  // namespace
}  // namespace soslam
