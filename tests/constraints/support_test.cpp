// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/support.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random.h"

namespace soslam {
namespace {

Eigen::Vector3d Residuals(const Plane& plane, const Landmark& landmark) {
  const SupportResidual residual(plane, 4.0, 9.0);
  const LandmarkBlock block = Pack(landmark);
  const double* blocks[] = {block.data()};
  Eigen::Vector3d values = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(residual.Evaluate(blocks, values.data(), nullptr));
  return values;
}

TEST(SupportResidual, IsZeroForAnUprightLandmarkOnThePlane) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), RandomUniform(-2, 2)};
    Landmark landmark;
    landmark.half_axes = RandomVector(0.05, 1.0);
    landmark.frame_from_object.rotation = UprightRotation(plane.normal, RandomUniform(-3, 3));
    const Eigen::Vector3d anywhere = RandomVector(-3, 3);
    landmark.frame_from_object.translation =
        anywhere + (landmark.half_axes.z() - plane.SignedDistance(anywhere)) * plane.normal;
    EXPECT_LT(Residuals(plane, landmark).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Half axes 1, 2, 3, lying with the x axis up, centre 5 above the floor z = 0.
TEST(SupportResidual, WorkedByHand) {
  Landmark landmark;
  landmark.half_axes = {1, 2, 3};
  landmark.frame_from_object.rotation =
      Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  landmark.frame_from_object.translation = {7, 8, 5};
  const Eigen::Vector3d expected(1.0 / 2.0, 0.0, (1.0 - 25.0) / 3.0);
  EXPECT_LT((Residuals(Plane(), landmark) - expected).norm(), 1e-12);
}

TEST(SupportResidual, TangencyEqualsTheDualQuadricForm) {
  const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), 0.7};
  const Landmark landmark{RandomRigid(), RandomVector(0.1, 1.0)};
  const Eigen::Vector4d pi = plane.Homogeneous();
  EXPECT_NEAR(3.0 * Residuals(plane, landmark).z(), pi.dot(DualQuadric(landmark) * pi), 1e-9);
}

TEST(SupportResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane{RandomRotation() * Eigen::Vector3d::UnitZ(), RandomUniform(-1, 1)};
    const LandmarkBlock block = Pack(Landmark{RandomRigid(), RandomVector(0.1, 1.0)});
    ExpectCorrectJacobians(SupportResidual(plane, 0.2, 0.5), {block.data()});
  }
}

TEST(SupportResidual, DoesNotChangeWithTheWorld) {
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
