// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/standing_on_plane.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/standing_landmarks.h"

namespace soslam {
namespace {

constexpr StandingSigmas kSigmas = {0.5, 0.01};

Eigen::Vector3d UprightResiduals(const Plane& plane, const Landmark& landmark) {
  return StandingOnPlane(landmark, plane, kSigmas, false).residuals;
}

Eigen::Vector3d LeaningResiduals(const Plane& plane, const Landmark& landmark) {
  return StandingOnPlane(landmark, plane, kSigmas, true).residuals;
}

// A body of any attitude whose lowest point is on the plane.
Landmark RandomLeaning(const Plane& plane, const ShapeExponents& shape_exponents) {
  Landmark landmark{RandomRigid(), RandomVector(0.1, 1.0), shape_exponents};
  const Eigen::Vector3d lowest = FindSupportPoint(landmark, -plane.normal).point;
  landmark.frame_from_object.translation -= plane.SignedDistance(lowest) * plane.normal;
  return landmark;
}

// Unlike pi^T Q* pi, it also tells above the plane from below, and counts metres for any size.
TEST(StandingOnPlane, CountsTheHeightOverThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    Landmark landmark = RandomStanding(plane);
    const double rise_m = RandomUniform(-3.0, 3.0);
    landmark.frame_from_object.translation += rise_m * plane.normal;
    EXPECT_LT((UprightResiduals(plane, landmark) - Eigen::Vector3d(0, 0, rise_m / 0.01)).norm(),
              1e-9);
  }
}

TEST(StandingOnPlane, WorkedByHand) {
  // x is along the normal: cosine 1 over half a radian. The foot is 5 - 3 = 2 m over the floor.
  EXPECT_LT((UprightResiduals(Plane(), LyingLandmark()) - Eigen::Vector3d(2.0, 0.0, 200.0)).norm(),
            1e-9);
}

TEST(StandingOnPlane, OfABodyThatLeansCountsTheHeightOfTheLowestPointAndTheTilt) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    Landmark landmark = RandomLeaning(plane, RandomUniform(1.0, 2.0));
    const double rise_m = RandomUniform(-0.5, 0.5);
    landmark.frame_from_object.translation += rise_m * plane.normal;
    const Eigen::Vector3d residuals = LeaningResiduals(plane, landmark);
    EXPECT_NEAR(residuals.z(), rise_m / 0.01, 1e-9);
    const double cosine =
        (landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ()).dot(plane.normal);
    EXPECT_NEAR(residuals.head<2>().norm(), std::sqrt(1.0 - cosine * cosine) / 0.5, 1e-9);
  }
}

TEST(StandingOnPlaneResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const double p = RandomUniform(1.05, 2.0);
    const LandmarkBlock block =
        ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0), p});
    const Plane plane = RandomPlane();
    for (const bool may_lean : {true, false}) {
      for (const double side : {1.0, -1.0}) {
        ExpectCorrectJacobians(StandingOnPlaneResidual(p, {0.2, 0.5}, may_lean, side),
                               {block.data(), plane.normal.data(), &plane.offset});
      }
    }
  }
}

TEST(StandingOnPlaneResidual, OtherSideIsTheOppositeNormal) {
  const Plane plane = RandomPlane();
  const Eigen::Vector3d opposite = -plane.normal;
  const LandmarkBlock block = ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
  EXPECT_EQ(ResidualsAt(StandingOnPlaneResidual(kEllipsoidExponent, kSigmas, false, -1.0),
                        {block.data(), opposite.data(), &plane.offset}),
            UprightResiduals(plane, UnpackLandmark(block.data())));
}

}  // namespace
}  // namespace soslam
