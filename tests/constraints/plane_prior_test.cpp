// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/constraints/standing_on_plane.h"
#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

// Information from two directions that are orthogonal to up: semidefinite.
Eigen::Matrix3d RandomInformation() {
  const Eigen::Vector3d one = RandomVector(-3, 3);
  const Eigen::Vector3d other = RandomVector(-3, 3);
  return one * one.transpose() + other * other.transpose();
}

TEST(PlaneNormalPrior, CostIsTheQuadraticForm) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix3d information = RandomInformation();
    const Eigen::Vector3d normal = RandomPlane().normal;
    EXPECT_NEAR(ResidualsAt(*PlaneNormalPrior(information), {normal.data()}).squaredNorm(),
                normal.dot(information * normal), 1e-10);
  }
}

TEST(PlaneHeightResidual, IsTheDistanceOfThePointInSigmas) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const HeightPrior prior{RandomVector(-3, 3), RandomUniform(0.01, 1.0)};
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d shared = side * plane.normal;
      const Eigen::VectorXd residual =
          ResidualsAt(PlaneHeightResidual(prior, side), {shared.data(), &plane.offset});
      EXPECT_NEAR(residual[0] * prior.sigma_m, plane.SignedDistance(prior.point_in_world), 1e-12);
    }
  }
}

TEST(PlaneHeightResidual, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const HeightPrior prior{RandomVector(-3, 3), RandomUniform(0.01, 1.0)};
    ExpectCorrectJacobians(PlaneHeightResidual(prior, i % 2 == 0 ? 1.0 : -1.0),
                           {plane.normal.data(), &plane.offset});
  }
}

}  // namespace
}  // namespace soslam
