// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/upright_on_plane.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/standing_landmarks.h"

namespace soslam {
namespace {

// Sigmas of half a radian and a centimetre.
Eigen::Vector3d UprightResiduals(const Plane& plane, const Landmark& landmark) {
  return ResidualsAt(UprightOnPlaneResidual(0.5, 0.01),
                     {ToParameterBlock(landmark).data(), plane.normal.data(), &plane.offset});
}

TEST(UprightOnPlaneResidual, IsZeroForAnUprightLandmarkOnThePlane) {
  ExpectZeroForStandingLandmarks(UprightResiduals);
}

// Unlike pi^T Q* pi, it also tells above the plane from below, and counts metres for any size.
TEST(UprightOnPlaneResidual, CountsTheHeightOverThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    Landmark landmark = RandomStanding(plane);
    const double rise_m = RandomUniform(-3.0, 3.0);
    landmark.frame_from_object.translation += rise_m * plane.normal;
    EXPECT_LT((UprightResiduals(plane, landmark) - Eigen::Vector3d(0, 0, rise_m / 0.01)).norm(),
              1e-9);
  }
}

TEST(UprightOnPlaneResidual, WorkedByHand) {
  // x is along the normal: cosine 1 over half a radian. The foot is 5 - 3 = 2 m over the floor.
  EXPECT_LT((UprightResiduals(Plane(), LyingLandmark()) - Eigen::Vector3d(2.0, 0.0, 200.0)).norm(),
            1e-9);
}

TEST(UprightOnPlaneResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const LandmarkBlock block = ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    const Plane plane = RandomPlane();
    for (const double side : {1.0, -1.0}) {
      ExpectCorrectJacobians(UprightOnPlaneResidual(0.2, 0.5, side),
                             {block.data(), plane.normal.data(), &plane.offset});
    }
  }
}

TEST(UprightOnPlaneResidual, OtherSideIsTheOppositeNormal) {
  const Plane plane = RandomPlane();
  const Eigen::Vector3d opposite = -plane.normal;
  const LandmarkBlock block = ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
  EXPECT_EQ(ResidualsAt(UprightOnPlaneResidual(0.5, 0.01, -1.0),
                        {block.data(), opposite.data(), &plane.offset}),
            UprightResiduals(plane, UnpackLandmark(block.data())));
}

}  // namespace
}  // namespace soslam
