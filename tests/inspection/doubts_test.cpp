// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/random.h"

namespace soslam {
namespace {

using testing::HasSubstr;

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

// A sphere of radius 0.5 whose centre and sizes have these standard deviations.
ObjectEstimate Sphere(double sigma_of_centre, double log_sigma_of_sizes) {
  ObjectEstimate estimate;
  estimate.landmark_in_world = Landmark{{}, Eigen::Vector3d::Constant(0.5), 2.0};
  Covariance9 covariance = Covariance9::Zero();
  covariance.block<3, 3>(3, 3).diagonal().setConstant(sigma_of_centre * sigma_of_centre);
  covariance.block<3, 3>(6, 6).diagonal().setConstant(log_sigma_of_sizes * log_sigma_of_sizes);
  estimate.covariance = covariance;
  return estimate;
}

TEST(DoubtsInWords, AreOfPlaceSizesAndSightings) {
  // 1.96 * 0.25 = 0.49, of 0.26: 0.51; exp(1.96 * 0.35) = 1.99, of 0.36: 2.03.
  EXPECT_EQ(DoubtsInWords(Sphere(0.25, 0.35), Sightings{5, 10}, kUp), "");
  EXPECT_EQ(DoubtsInWords(Sphere(0.26, 0.1), {}, kUp), "it may stand beside its outline");
  EXPECT_EQ(DoubtsInWords(Sphere(0.1, 0.36), {}, kUp),
            "its depth and width and height may be half or twice as large");
  EXPECT_EQ(DoubtsInWords(Sphere(0.1, 0.1), Sightings{4, 10}, kUp),
            "detected in only 4 of the 10 images that should show it");
  EXPECT_EQ(
      DoubtsInWords(Sphere(0.26, 0.1), Sightings{1, 3}, kUp),
      "detected in only 1 of the 3 images that should show it; it may stand beside its outline");
}

TEST(DoubtsInWords, WithoutCovarianceAreOfSightingsOnly) {
  ObjectEstimate estimate = Sphere(9.0, 9.0);
  estimate.covariance.reset();
  EXPECT_EQ(DoubtsInWords(estimate, {}, kUp), "");
  EXPECT_THAT(DoubtsInWords(estimate, Sightings{1, 9}, kUp), HasSubstr("only 1 of the 9"));
}

// Along the thin axis of a board 0.3 m are more than it reaches, along the others they are not;
// that it may be higher or lower by that says nothing of where it stands.
TEST(DoubtsInWords, ComparePlaceAndBodyInTheSameHorizontalDirectionWhateverTheWorld) {
  for (int i = 0; i < 50; ++i) {
    const Rigid3d world_from_object = RandomRigid();
    const Eigen::Matrix3d rotation = world_from_object.rotation.toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (int up = 0; up < 3; ++up) {
        ObjectEstimate estimate = Sphere(0.01, 0.1);
        estimate.landmark_in_world = Landmark{world_from_object, {1.0, 0.1, 1.0}, kCuboidExponent};
        Eigen::Vector3d sigmas(0.01, 0.02, 0.03);
        sigmas[axis] = 0.3 / 1.96;
        estimate.covariance->block<3, 3>(3, 3) =
            rotation * sigmas.cwiseAbs2().asDiagonal() * rotation.transpose();
        EXPECT_EQ(DoubtsInWords(estimate, {}, rotation.col(up)).empty(), axis != 1 || up == 1)
            << axis << " " << up;
      }
    }
  }
}

}  // namespace
}  // namespace soslam
