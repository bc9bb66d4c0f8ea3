// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/initialisation/upright.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

TEST(UprightLandmark, HasTheGivenYawFootAndHalfAxesAndTellsThem) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    const UprightVector parameters = RandomUprightParameters();
    const Landmark landmark = UprightParametrisation(plane).LandmarkAt(parameters, 1.5);
    EXPECT_NEAR(Yaw(plane.normal, landmark.frame_from_object.rotation), parameters(0), 1e-12);
    EXPECT_LT((landmark.half_axes.array() - parameters.segment<3>(3).array().exp()).matrix().norm(),
              1e-12);
    // The foot, from the point of the plane that is nearest to the origin.
    const Eigen::Vector3d foot =
        landmark.Centre() - plane.SignedDistance(landmark.Centre()) * plane.normal;
    const Eigen::Vector3d from_nearest = foot + plane.offset * plane.normal;
    const Eigen::Vector3d along_axes =
        UprightRotation(plane.normal, 0.0).conjugate() * from_nearest;
    EXPECT_LT((along_axes - Eigen::Vector3d(parameters(1), parameters(2), 0.0)).norm(), 1e-12);
    EXPECT_LT((UprightParametrisation(plane).ComputeParameters(landmark) - parameters).norm(),
              1e-12);
  }
}

TEST(UprightByParameters, AgreesWithNumbers) {
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const UprightVector parameters = RandomUprightParameters();
    const Landmark landmark = UprightParametrisation(plane).LandmarkAt(parameters, 1.5);
    // The nine parameters of kLandmarkDof, from those of the landmark.
    const auto moved = [&](int k, double step) {
      UprightVector at = parameters;
      at(k) += step;
      const Landmark other = UprightParametrisation(plane).LandmarkAt(at, 1.5);
      LandmarkStep tangent;
      tangent << LogRotation(other.frame_from_object.rotation *
                             landmark.frame_from_object.rotation.conjugate()),
          other.Centre() - landmark.Centre(),
          (other.half_axes.array() / landmark.half_axes.array()).log().matrix();
      return tangent;
    };
    const UprightJacobian jacobian = UprightParametrisation(plane).ParameterJacobian(landmark);
    for (int k = 0; k < 7; ++k) {
      const LandmarkStep numeric = (8.0 * (moved(k, kStep) - moved(k, -kStep)) -
                                    (moved(k, 2.0 * kStep) - moved(k, -2.0 * kStep))) /
                                   (12.0 * kStep);
      EXPECT_LT((jacobian.col(k) - numeric).norm(), 1e-9)
          << "parameter " << k << ": analytic " << jacobian.col(k).transpose() << ", numeric "
          << numeric.transpose();
    }
  }
}

}  // namespace
}  // namespace soslam
