// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/body.h"

#include <gtest/gtest.h>

#include <cmath>

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

Landmark Shaped(Landmark landmark, Shape shape) {
  landmark.shape_exponents = ExponentsOf(shape);
  return landmark;
}

TEST(ExactOutline, BackProjectedEdgesAreTangent) {
  const Camera camera = TestCamera();
  for (const Shape shape : {Shape::kBox, Shape::kEllipsoid, Shape::kCylinder}) {
    for (int trial = 0; trial < 200; ++trial) {
      const Landmark body = Shaped(RandomLandmarkInCamera(), shape);
      const Box outline = ExactOutline(camera, body).value();
      EXPECT_GT(outline.Width(), 0.0);
      EXPECT_GT(outline.Height(), 0.0);
      for (const Eigen::Vector3d& line : outline.EdgeLines()) {
        const Plane plane_in_camera = camera.BackProject(line);
        const Eigen::Vector3d normal_in_object =
            body.frame_from_object.rotation.conjugate() * plane_in_camera.normal;
        const double extent = Support(shape, body.half_axes, normal_in_object);
        // Rounding only: metres, at 2.5 to 5 metres.
        EXPECT_NEAR(std::abs(plane_in_camera.SignedDistance(body.Centre())), extent, 1e-12);
      }
    }
  }
}

TEST(ExactOutline, NoneUnlessWhollyInFront) {
  for (const Shape shape : {Shape::kBox, Shape::kEllipsoid, Shape::kCylinder}) {
    for (const double depth : {0.2, -5.0}) {
      const Landmark body = {{RandomRotation(), {0.0, 0.0, depth}}, {0.5, 0.4, 0.3}};
      EXPECT_FALSE(ExactOutline(TestCamera(), Shaped(body, shape))) << depth;
    }
  }
}

}  // namespace
}  // namespace soslam
