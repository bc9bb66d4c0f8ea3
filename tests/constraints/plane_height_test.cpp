// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/plane_height.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

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
