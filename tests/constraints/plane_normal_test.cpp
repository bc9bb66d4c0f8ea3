// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/plane_normal.h"

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

}  // namespace
}  // namespace soslam
