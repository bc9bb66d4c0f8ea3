// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/constraints/quadric_constraints.h"
#include "support/jacobians.h"
#include "support/standing_landmarks.h"

namespace soslam {
namespace {

// Variances of 4 rad^2 and 9 m^4.
Eigen::Vector3d SupportResiduals(const Plane& plane, const Landmark& landmark) {
  return ResidualsAt(SupportResidual(plane, 4.0, 9.0), {ToParameterBlock(landmark).data()});
}

TEST(SupportResidual, IsZeroForAnUprightLandmarkOnThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    EXPECT_LT(SupportResiduals(plane, RandomStanding(plane)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(SupportResidual, WorkedByHand) {
  // x is along the normal; pi^T Q* pi is 1^2, the half axis that is up, less 5^2, the height.
  const Eigen::Vector3d expected(1.0 / 2.0, 0.0, (1.0 - 25.0) / 3.0);
  EXPECT_LT((SupportResiduals(Plane(), LyingLandmark()) - expected).norm(), 1e-12);
}

TEST(SupportResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const LandmarkBlock block = ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    ExpectCorrectJacobians(SupportResidual(RandomPlane(), 0.2, 0.5), {block.data()});
  }
}

}  // namespace
}  // namespace soslam
