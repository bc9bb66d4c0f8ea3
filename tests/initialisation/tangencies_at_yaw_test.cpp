// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/tangencies_at_yaw.h"

#include <gtest/gtest.h>

#include "initialisation/box_fit.h"
#include "initialisation/closed_form.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// On its best foot a body has the cost and the gradient that it has when the foot is a parameter,
// and of the half axes' information what is left when the foot is unknown.
TEST(TangenciesAtYaw, AreThoseOfTheBestFoot) {
  int checked = 0;
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(p);
      UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
      observation.prior.log_sigma = {1e9, 1e9};  // nothing but the box counts
      observation.axes_weight = 0.0;
      const auto start = ClosedForm(observation).At(RandomYaw());
      if (!start) continue;
      ++checked;
      const BoxFit fit(observation);
      const Eigen::Array4d depths_m = fit.TangentDepths(*start);
      const BoxOnGround box(observation.edges, Rigid3d(), fit.ground());
      const TangenciesAtYaw tangencies(box, depths_m, (*start)[0], p);
      ASSERT_TRUE(tangencies.TellTheFoot());

      UprightVector at = *start;
      at.tail<3>() += RandomVector(-0.1, 0.1);
      at.segment<2>(1) = tangencies.BestFoot(at.tail<3>());
      const QuadraticModel<6> whole = fit.Evaluate(depths_m, at);
      const QuadraticModel<3> model = tangencies.Evaluate(at.tail<3>());
      const double scale = whole.information.norm();
      EXPECT_LT(whole.gradient.segment<2>(1).norm(), 1e-9 * scale);
      EXPECT_NEAR(model.cost, whole.cost, 1e-9 * (1.0 + whole.cost));
      EXPECT_LT((model.gradient - whole.gradient.tail<3>()).norm(), 1e-9 * scale);
      const Eigen::Matrix<double, 3, 2> mixed = whole.information.block<3, 2>(3, 1);
      const Eigen::Matrix3d left =
          whole.information.bottomRightCorner<3, 3>() -
          mixed * whole.information.block<2, 2>(1, 1).inverse() * mixed.transpose();
      EXPECT_LT((model.information - left).norm(), 1e-9 * scale);
    }
  }
  EXPECT_GT(checked, 50);
}

TEST(TangenciesAtYaw, OfPlanesThatAllRunOneWayDoNotTellTheFoot) {
  const StandingBody body(2.0);
  BoxOnGround box(body.observation.edges, Rigid3d(), UprightGround(body.plane));
  const auto tell_the_foot = [&] {
    return TangenciesAtYaw(box, Eigen::Array4d::Ones(), 0.3, 2.0).TellTheFoot();
  };
  EXPECT_TRUE(tell_the_foot());
  box.normals.col(1) = 2.0 * box.normals.col(0);
  EXPECT_FALSE(tell_the_foot());
  box.normals.col(0) *= 1e-9;
  EXPECT_FALSE(tell_the_foot());
  box.normals.col(0).setZero();
  EXPECT_FALSE(tell_the_foot());
}

}  // namespace
}  // namespace soslam
