// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include "geometry/landmark.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(RestingFace, FramesAreRotationsWithTheirAxisUp) {
  const Eigen::Vector3d up[] = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                                Eigen::Vector3d::UnitY()};
  for (const RestingFace face : kRestingFaces) {
    const Eigen::Matrix3d own_from_object = OwnFromObject(face);
    EXPECT_EQ(own_from_object * own_from_object.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(own_from_object.determinant(), 1.0);
    EXPECT_EQ(own_from_object.col(2), up[static_cast<size_t>(face)]);
    EXPECT_EQ(std::abs(own_from_object(2, OwnHeightAxis(face))), 1.0);
  }
}

TEST(RestingFace, BodyInItsOwnAxesIsTheSame) {
  for (const RestingFace face : kRestingFaces) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d own_half_axes = RandomVector(0.1, 1.0);
      const Landmark landmark{RandomRigid(), HalfAxesOnFace(own_half_axes, face), 1.3, face};
      const Landmark own = InOwnAxes(landmark);
      EXPECT_EQ(own.half_axes, own_half_axes);
      EXPECT_EQ(own.rests_on, RestingFace::kBottom);
      for (int k = 0; k < 10; ++k) {
        const Eigen::Vector3d direction = RandomVector(-1.0, 1.0);
        EXPECT_NEAR(FindSupportPoint(own, direction).extent,
                    FindSupportPoint(landmark, direction).extent, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace soslam
