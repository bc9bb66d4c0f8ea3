// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/plane_prior.h"

#include <gtest/gtest.h>

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

TEST(PlaneNormalResidual, CostIsTheQuadraticForm) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix3d information = RandomInformation();
    const Eigen::Vector3d normal = RandomPlane().normal;
    const double* blocks[] = {normal.data()};
    Eigen::Vector3d residuals;
    ASSERT_TRUE(PlaneNormalResidual(information).Evaluate(blocks, residuals.data(), nullptr));
    EXPECT_NEAR(residuals.squaredNorm(), normal.dot(information * normal), 1e-10);
  }
}

TEST(PlaneNormalResidual, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d normal = RandomPlane().normal;
    ExpectCorrectJacobians(PlaneNormalResidual(RandomInformation()), {normal.data()});
  }
}

TEST(PlaneHeightResidual, IsTheDistanceOfThePointInSigmas) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const HeightPrior prior{RandomVector(-3, 3), RandomUniform(0.01, 1.0)};
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d shared = side * plane.normal;
      const double* blocks[] = {shared.data(), &plane.offset};
      double residual = 0.0;
      ASSERT_TRUE(PlaneHeightResidual(prior, side).Evaluate(blocks, &residual, nullptr));
      EXPECT_NEAR(residual * prior.sigma_m, plane.SignedDistance(prior.point_in_world), 1e-12);
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
