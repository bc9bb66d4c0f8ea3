// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/leaning_on_plane.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/standing_landmarks.h"

namespace soslam {
namespace {

constexpr LeaningSigmas kSigmas = {0.5, 0.01};

// A body of any attitude whose lowest point is on the plane.
Landmark RandomLeaning(const Plane& plane, const ShapeExponents& shape_exponents) {
  Landmark landmark{RandomRigid(), RandomVector(0.1, 1.0), shape_exponents};
  const Eigen::Vector3d lowest = FindSupportPoint(landmark, -plane.normal).point;
  landmark.frame_from_object.translation -= plane.SignedDistance(lowest) * plane.normal;
  return landmark;
}

TEST(LeaningOnPlane, CountsTheHeightOfTheLowestPointAndTheTilt) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    Landmark landmark = RandomLeaning(plane, RandomUniform(1.0, 2.0));
    const double rise_m = RandomUniform(-0.5, 0.5);
    landmark.frame_from_object.translation += rise_m * plane.normal;
    const Eigen::Vector3d residuals = LeaningOnPlane(landmark, plane, kSigmas).residuals;
    EXPECT_NEAR(residuals.z(), rise_m / 0.01, 1e-9);
    const double cosine =
        (landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ()).dot(plane.normal);
    EXPECT_NEAR(residuals.head<2>().norm(), std::sqrt(1.0 - cosine * cosine) / 0.5, 1e-9);
  }
}

TEST(LeaningOnPlane, IsZeroForAnUprightEllipsoidOnThePlane) {
  ExpectZeroForStandingLandmarks([](const Plane& plane, const Landmark& landmark) {
    return LeaningOnPlane(landmark, plane, kSigmas).residuals;
  });
}

TEST(LeaningOnPlaneResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const double p = RandomUniform(1.05, 2.0);
    const LandmarkBlock block =
        ToParameterBlock(Landmark{RandomRigid(), RandomVector(0.1, 1.0), p});
    const Plane plane = RandomPlane();
    for (const double side : {1.0, -1.0}) {
      ExpectCorrectJacobians(LeaningOnPlaneResidual(p, {0.2, 0.5}, side),
                             {block.data(), plane.normal.data(), &plane.offset});
    }
  }
}

}  // namespace
}  // namespace soslam
