// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/standing.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

Eigen::Vector3d Residuals(const Plane& plane, const Landmark& landmark) {
  const StandingResidual residual(plane, 0.5, 0.01);
  const LandmarkBlock block = Pack(landmark);
  const double* blocks[] = {block.data()};
  Eigen::Vector3d values = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(residual.Evaluate(blocks, values.data(), nullptr));
  return values;
}

Landmark RandomStanding(const Plane& plane) {
  Landmark landmark;
  landmark.half_axes = RandomVector(0.01, 1.0);
  landmark.frame_from_object.rotation = UprightRotation(plane.normal, RandomUniform(-3, 3));
  const Eigen::Vector3d anywhere = RandomVector(-3, 3);
  landmark.frame_from_object.translation =
      anywhere + (landmark.half_axes.z() - plane.SignedDistance(anywhere)) * plane.normal;
  return landmark;
}

TEST(StandingResidual, IsZeroForAnUprightLandmarkOnThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), RandomUniform(-2, 2)};
    EXPECT_LT(Residuals(plane, RandomStanding(plane)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Unlike pi^T Q* pi, it also tells above the plane from below, and counts metres for any size.
TEST(StandingResidual, CountsTheHeightOverThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), RandomUniform(-2, 2)};
    Landmark landmark = RandomStanding(plane);
    const double rise_m = RandomUniform(-3.0, 3.0);
    landmark.frame_from_object.translation += rise_m * plane.normal;
    EXPECT_LT((Residuals(plane, landmark) - Eigen::Vector3d(0, 0, rise_m / 0.01)).norm(), 1e-9);
  }
}

// Lying with the x axis up, its centre 5 over the floor z = 0.
TEST(StandingResidual, WorkedByHand) {
  const Landmark landmark{
      {Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY())),
       {7, 8, 5}},
      {1, 2, 3}};
  EXPECT_LT((Residuals(Plane(), landmark) - Eigen::Vector3d(2.0, 0.0, 200.0)).norm(), 1e-9);
}

TEST(StandingResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), RandomUniform(-1, 1)};
    const LandmarkBlock block = Pack(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    ExpectCorrectJacobians(StandingResidual(plane, 0.2, 0.5), {block.data()});
  }
}

TEST(StandingResidual, DoesNotChangeWithTheWorld) {
  const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), 0.4};
  const Landmark landmark{RandomRigid(), RandomVector(0.1, 1.0)};
  const Rigid3d motion = RandomRigid(10.0);
  EXPECT_LT((Residuals(Transform(motion, plane), Transform(motion, landmark)) -
             Residuals(plane, landmark))
                .norm(),
            1e-9);
}

}  // namespace
}  // namespace soslam
