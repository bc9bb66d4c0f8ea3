// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random.h"

namespace soslam {
namespace {

// The solid that touches a plane from behind: max over its points of n . x, by shape, in the object
// frame. What the library derives from dual quadrics and corners, in another way.
double Support(Shape shape, const Eigen::Vector3d& half_axes, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d scaled = half_axes.cwiseProduct(normal);
  if (shape == Shape::kBox) return scaled.lpNorm<1>();
  if (shape == Shape::kEllipsoid) return scaled.norm();
  return scaled.head<2>().norm() + std::abs(scaled.z());
}

class BodyTest : public testing::TestWithParam<Shape> {
 protected:
  // The landmark with the shape under test.
  static Landmark Shaped(Landmark landmark) {
    landmark.shape_exponents = ExponentsOf(GetParam());
    return landmark;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, BodyTest,
                         testing::Values(Shape::kBox, Shape::kEllipsoid, Shape::kCylinder));

TEST_P(BodyTest, BackProjectedBoxEdgesAreTangent) {
  const Camera camera = TestCamera();
  for (int trial = 0; trial < 200; ++trial) {
    const Landmark body = Shaped(RandomLandmarkInCamera());
    const Rigid3d& camera_from_object = body.frame_from_object;
    const Box outline = ExactOutline(camera, body).value();
    EXPECT_GT(outline.Width(), 0.0);
    EXPECT_GT(outline.Height(), 0.0);
    for (const Eigen::Vector3d& line : outline.EdgeLines()) {
      const Plane plane_in_camera = camera.BackProject(line);
      const Eigen::Vector3d normal_in_object =
          camera_from_object.rotation.conjugate() * plane_in_camera.normal;
      const double extent = Support(GetParam(), body.half_axes, normal_in_object);
      // Rounding only: metres, at 2.5 to 5 metres.
      EXPECT_NEAR(std::abs(plane_in_camera.SignedDistance(body.Centre())), extent, 1e-12);
    }
  }
}

TEST_P(BodyTest, NoOutlineUnlessWhollyInFront) {
  const Landmark landmark = {{RandomRotation(), {0.0, 0.0, 0.2}}, {0.5, 0.4, 0.3}};
  EXPECT_FALSE(ExactOutline(TestCamera(), Shaped(landmark)));
  const Landmark behind = {{RandomRotation(), {0.0, 0.0, -5.0}}, {0.5, 0.4, 0.3}};
  EXPECT_FALSE(ExactOutline(TestCamera(), Shaped(behind)));
}

}  // namespace
}  // namespace soslam
